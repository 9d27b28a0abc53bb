// test_mesh_tree.cpp: distance to meshes against all triangles, signs by formula, gradients, edges, corners, notches.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "shapes/analytic_shapes.h"
#include "shapes/mesh_tree.h"
#include "shapes/zero_set.h"
#include "tests/support/l_prism.h"

namespace scree {
namespace {

using testing::inside_l_prism;
using testing::l_prism;

double brute_distance(TriangleMesh const& mesh, Vec3 x) {
  double best = std::numeric_limits<double>::infinity();
  for (auto const& t : mesh.triangle)
    best =
        std::min(best, norm(x - closest_on_triangle(mesh.vertex[t[0]], mesh.vertex[t[1]], mesh.vertex[t[2]], x).point));
  return best;
}

// p is the closest point of a convex set exactly if no corner lies beyond the plane through p across x - p.
TEST(ClosestOnTriangle, SatisfiesTheOptimalityConditionOnEveryFeature) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1, 1);
  auto const draw = [&] { return Vec3{u(random), u(random), u(random)}; };
  int seen[7] = {};
  for (int i = 0; i < 3000; ++i) {
    Vec3 const c[3] = {draw(), draw(), draw()}, x = draw() * 2;
    TrianglePoint const hit = closest_on_triangle(c[0], c[1], c[2], x);
    ++seen[hit.feature];
    for (Vec3 corner : c) EXPECT_LE(dot(x - hit.point, corner - hit.point), 1e-12);
    Vec3 const n = cross(c[1] - c[0], c[2] - c[0]);
    EXPECT_NEAR(dot(hit.point - c[0], n), 0, 1e-12);
    if (hit.feature == 0) {
      EXPECT_LT(norm(cross(x - hit.point, n)), 1e-10 * norm(n));
    } else if (hit.feature >= 4) {
      EXPECT_EQ(hit.point, c[hit.feature - 4]);
    }
    if (hit.feature >= 1 && hit.feature <= 3) {
      Vec3 const a = c[hit.feature - 1], b = c[hit.feature % 3];
      EXPECT_LT(norm(cross(hit.point - a, b - a)), 1e-12);
    }
  }
  for (int count : seen) EXPECT_GT(count, 20);
}

TEST(MeshTree, EqualsBruteForceOnABodyWithANotch) {
  MeshTree const tree(l_prism());
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1, 3);
  for (int i = 0; i < 3000; ++i) {
    Vec3 const x{u(random), u(random), u(random)};
    Vec3 gradient;
    double const phi = mesh_distance(tree.sdf(), x, &gradient);
    EXPECT_NEAR(std::abs(phi), brute_distance(tree.mesh(), x), 1e-14);
    EXPECT_EQ(phi > 0, inside_l_prism(x)) << x.x << " " << x.y << " " << x.z;
    EXPECT_NEAR(norm(gradient), 1, 1e-12);
    // A step along the gradient by -phi ends on the surface.
    EXPECT_NEAR(mesh_distance(tree.sdf(), x - gradient * phi, nullptr), 0, 1e-12);
  }
}

TEST(MeshTree, EqualsBruteForceOnAThousandTriangles) {
  Library library;
  library.shape = {builtin_shape("ellipsoid:1:0.7:0.5")};
  TriangleMesh const mesh = find_zero_set(surface_phi(library, library.shape[0]), {0.8, 12, 1}).mesh;
  ASSERT_GT(mesh.triangle.size(), 1000u);
  MeshTree const tree(mesh);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-0.8, 0.8);
  for (int i = 0; i < 500; ++i) {
    Vec3 const x{u(random), u(random), u(random)};
    double const phi = mesh_distance(tree.sdf(), x, nullptr), truth = evaluate_reference(library, library.shape[0], x);
    EXPECT_NEAR(std::abs(phi), brute_distance(mesh, x), 1e-14);
    EXPECT_NEAR(phi, truth, 0.02);  // chords of edges of 0.1 on a radius of 0.2
  }
}

// Points whose closest point is a corner or lies on an edge, from outside and from inside a notch.
TEST(MeshTree, SignsAtEdgesAndCorners) {
  MeshTree const tree(l_prism());
  double const e = 1e-3;
  for (double z : {0.5, 1.0}) {
    EXPECT_LT(mesh_distance(tree.sdf(), {1 + e, 1 + e, z}, nullptr), 0);  // in the notch: the closest edge is concave
    EXPECT_LE(mesh_distance(tree.sdf(), {1 - e, 1 - e, z}, nullptr), std::sqrt(2.0) * e + 1e-12);
  }
  EXPECT_NEAR(mesh_distance(tree.sdf(), {1 - e, 1 - e, 0.5}, nullptr), std::sqrt(2.0) * e, 1e-12);
  EXPECT_NEAR(mesh_distance(tree.sdf(), {-3, -4, 0.5}, nullptr), -5, 1e-12);
  EXPECT_NEAR(mesh_distance(tree.sdf(), {2 + 6, 1 + 2, 1 + 3}, nullptr), -7, 1e-12);  // the corner (2, 1, 1)
  Vec3 gradient;
  mesh_distance(tree.sdf(), {2 + 6, 1 + 2, 1 + 3}, &gradient);
  EXPECT_LT(norm(gradient - Vec3{-6, -2, -3} / 7), 1e-12);
}

TEST(MeshTree, OnTheSurfaceTheGradientIsThePseudoNormal) {
  MeshTree const tree(l_prism());
  Vec3 gradient;
  EXPECT_NEAR(mesh_distance(tree.sdf(), {0.5, 0.3, 1}, &gradient), 0, 1e-15);
  EXPECT_LT(norm(gradient - Vec3{0, 0, -1}), 1e-15);
  EXPECT_EQ(mesh_distance(tree.sdf(), {2, 0, 0.5}, &gradient), 0);  // an edge of two faces
  EXPECT_LT(norm(gradient - normalized(Vec3{-1, 1, 0})), 1e-15);
  EXPECT_EQ(mesh_distance(tree.sdf(), {2, 0, 0}, &gradient), 0);  // a cube's corner: weighted by angle, not by triangle
  EXPECT_LT(norm(gradient - normalized(Vec3{-1, 1, 1})), 1e-15);
}

TEST(MeshTree, RefusesWhatIsNoMesh) {
  EXPECT_THROW(MeshTree(TriangleMesh{}), std::invalid_argument);
  TriangleMesh missing = l_prism();
  missing.triangle[3][1] = 12;
  EXPECT_THROW(MeshTree{missing}, std::invalid_argument);
  TriangleMesh nan = l_prism();
  nan.vertex[2].y = std::nan("");
  EXPECT_THROW(MeshTree{nan}, std::invalid_argument);
}

}  // namespace
}  // namespace scree
