// cgal_mesh.h: TriangleMesh to and from CGAL's half-edge mesh.
// Included by the .cpp files of this folder only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree::cgal {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

inline Point to_point(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3 to_vec(Point const& p) { return {p.x(), p.y(), p.z()}; }

// Throws std::invalid_argument where a triangle does not fit a manifold (an edge with three faces, or two faces that
// run through it in the same direction).
Mesh to_cgal(TriangleMesh const& mesh);
TriangleMesh from_cgal(Mesh const& mesh);

}  // namespace scree::cgal
