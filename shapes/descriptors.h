// descriptors.h: the numbers by which particle shapes are compared.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/triangle_mesh.h"

namespace scree {

struct Descriptors {
  double sphericity = 0;  // Wadell (1935): area of the equal-volume sphere over the area; 1 for a sphere
  double convexity = 0;   // volume over the volume of the convex hull
  double elongation = 0;  // EI = b / a of the extents a >= b >= c along x, y, z
  double flatness = 0;    // FI = c / b
};

// Of a closed mesh in its principal frame, any unit. Convexity: the hull is sampled in 4,098 directions and its volume
// extrapolated, error about 1e-4 on smooth bodies, 1e-3 on polyhedra. Throws std::invalid_argument when the volume is
// not positive.
Descriptors describe(TriangleMesh const& mesh);

}  // namespace scree
