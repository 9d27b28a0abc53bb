// mesh_measures.h: form measures of a closed mesh: hull, convexity, sphericity, aspect ratio, star-shapedness.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree {

// Convex hull by CGAL, in an order that only depends on the points; at least four points that are not in one plane,
// else std::invalid_argument.
TriangleMesh convex_hull(std::vector<Vec3> const& point);

double convexity(TriangleMesh const& mesh);  // volume / volume of the hull, at most 1

// Wadell (1932): area of the sphere of equal volume / area, at most 1.
double sphericity(TriangleMesh const& mesh);

// Longest over shortest extent along the principal axes, at least about 1.
double aspect_ratio(TriangleMesh const& mesh);

// Angle between outward normals across every edge of the closed mesh [rad]; edges within one flat face (below
// `coplanar`) are left out.
std::vector<double> dihedral_angles(TriangleMesh const& mesh, double coplanar = 1e-6);

// Largest t such that some point of the box lies at least t below the plane of every triangle: positive for a body that
// is star-shaped about an interior point, negative if no point sees the whole surface. Found on a grid of `cells`^3;
// as the function is 1-Lipschitz, `certain_below` bounds the true value from above.
struct StarKernel {
  double depth = 0;          // [unit]
  double certain_below = 0;  // depth + half a cell's diagonal [unit]
};
StarKernel star_kernel(TriangleMesh const& mesh, int cells = 24);

}  // namespace scree
