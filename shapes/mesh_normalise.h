// mesh_normalise.h: move a closed mesh to the frame of shapes.md: volume pi/6, centroid at the origin, principal axes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/vec.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// normalised = scale * rotation * (x - centroid): right-handed; the longest principal axis (least inertia) along x, the
// shortest along z. Where two principal moments agree to 1e-6 the axes are whatever the solver returns.
struct Normalisation {
  Vec3 centroid;
  Mat3 rotation;
  double scale = 1;

  Vec3 operator()(Vec3 x) const { return rotation * (x - centroid) * scale; }
};

// Throws std::invalid_argument if the volume is not positive.
Normalisation normalisation_of(TriangleMesh const& mesh);
TriangleMesh transformed(TriangleMesh const& mesh, Normalisation const& normalisation);
TriangleMesh normalised(TriangleMesh const& mesh);

}  // namespace scree
