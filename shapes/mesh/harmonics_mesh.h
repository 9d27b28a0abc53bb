// harmonics_mesh.h: the triangle mesh of a body of spherical harmonics.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree {

// `vertices` evenly spread directions, connected as on their convex hull (section 2.4 of the reference paper), each at
// r(direction) of the coefficients (kernels/sdf/harmonics.h). 2 vertices - 4 triangles, outwards. Throws
// std::invalid_argument for fewer than four vertices, a count of coefficients that is no square, and where r <= 0.
TriangleMesh harmonics_mesh(std::vector<double> const& coefficient, int vertices);

}  // namespace scree
