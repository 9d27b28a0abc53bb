// roundness.h: how sharp a grain's corners and edges are, on a triangle mesh.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree {

// Wadell (1932): the mean radius of the corners over the radius of the largest inscribed ball; here on a surface, as in
// Zhao and Wang (2016, Powder Technology 291, 262): the corners are where the larger principal curvature k exceeds that
// of the ball. Departure: every piece of a corner weighs by how much the surface turns on it, A k, which neither the
// mesh nor the number of corners changes, so that the mean radius is sum A / sum A k over the corners. 1 for a sphere,
// r / a for a box of half its least side a with edges of radius r, towards 0 for sharp edges, where the mesh's cell
// takes the place of r. `normal`: outward unit normals at the vertices. Closed mesh, any unit.
double roundness(TriangleMesh const& mesh, std::vector<Vec3> const& normal);

// Radius of the largest ball inside the closed mesh, by search from a grid of 5^3 starts: from below, within about 1e-3
// of the box and h^2 / (8 R) above for the mesh's edge h.
double inscribed_radius(TriangleMesh const& mesh, std::vector<Vec3> const& normal);

}  // namespace scree
