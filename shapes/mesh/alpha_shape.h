// alpha_shape.h: a closed triangle mesh from a point cloud by CGAL's alpha shapes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree {

// alpha is CGAL's: the square of the radius of a ball that is kept out of the solid [unit^2]. The solid is all that
// such a ball cannot reach from outside without passing between points closer than its size: the alpha shape with its
// voids filled, so that a cloud of surface points alone gives a solid body down to the spacing of the points (the plain
// alpha shape of such a cloud is hollow as soon as alpha^(1/2) is below the body's inner radius).
struct AlphaShape {
  TriangleMesh mesh;       // boundary of the solid, outwards; its vertices are points of the cloud
  double alpha = 0;        // [unit^2]
  double smallest = 0;     // alpha from which on the solid is one part and leaves no point outside [unit^2]
  int parts = 0;           // solids that share no face
  int points_outside = 0;  // of the distinct points
};

// `alpha` <= 0: the smallest that makes one part, leaves no point outside and has a manifold surface. A given alpha is
// taken as it is, whatever comes out. Deterministic. Throws std::invalid_argument for fewer than four points, points in
// one plane, or a non-finite coordinate. 1 s for 10,000 points.
AlphaShape alpha_shape(std::vector<Vec3> const& point, double alpha = 0);

}  // namespace scree
