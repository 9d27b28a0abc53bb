// align.h: where a normalised shape lies in the frame of the mesh that it was made from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/mesh/certify.h"

namespace scree {

struct Alignment {
  BodyFrame frame;
  double rms = 0;  // of phi at points of the mesh's surface [d]
};

// Rotation, shift and scale with the least sum of phi^2 over points spread evenly over the surface of the closed mesh:
// from the principal axes in all their orders and senses, the best of these by Gauss and Newton. Bodies with two like
// moments of inertia are also tried turned about the third axis. Deterministic. `phi` needs only its zero set and a
// gradient near it. A shape that is not of this mesh gives a large rms. Throws std::invalid_argument when the volume of
// the mesh is not positive.
Alignment align_shape(PhiBatch const& phi, TriangleMesh const& mesh);

}  // namespace scree
