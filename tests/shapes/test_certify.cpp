// test_certify.cpp: errors against a mesh, for a phi whose errors are known.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kernels/sdf/analytic.h"
#include "shapes/mesh/certify.h"
#include "shapes/mesh/icosphere.h"
#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh/sharp_edges.h"
#include "shapes/mesh_normalise.h"

namespace scree {
namespace {

TriangleMesh box_mesh(Vec3 half) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertex.push_back({i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z});
  mesh.triangle = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

PhiBatch distance_of(MeshDistance const& mesh) {
  return [&mesh](Span<const Vec3> x, Span<double> phi, Span<Vec3> gradient) { mesh.evaluate(x, phi, gradient); };
}

TEST(Certify, AConstantErrorIsItsOwnMeanAndMaximum) {
  // The body: a box of equal-volume diameter 1, in a frame of its own, twice as large. The shape: the same box, its
  // phi too large by 0.004 d everywhere.
  Vec3 const half{0.5 * std::cbrt(std::numbers::pi / 6), 0.5 * std::cbrt(std::numbers::pi / 6),
                  0.5 * std::cbrt(std::numbers::pi / 6)};
  double constexpr offset = 0.004;
  AnalyticSdf const box{AnalyticKind::box, half, 1, 1};
  PhiBatch const phi = [&](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    for (int i = 0; i < x.size(); ++i) {
      Vec3 g;
      value[i] = signed_distance(box, x[i], &g) + offset;
      if (!gradient.empty()) gradient[i] = g;
    }
  };
  BodyFrame frame;
  frame.rotation = to_matrix(normalized(Quat{0.8, 0.3, -0.4, 0.2}));
  frame.shift = {0.02, -0.03, 0.01};
  frame.scale = 2;
  TriangleMesh mesh = box_mesh(half);
  for (Vec3& v : mesh.vertex) v = frame.to_body(v);
  MeshDistance const distance(mesh);
  Certificate c;
  certify(phi, truth_of(mesh, distance_of(distance)), frame, 4000, 1, c);
  for (double error : {c.mae, c.p99, c.max, c.band_mae, c.band_p99, c.band_max}) EXPECT_NEAR(error, offset, 1e-9);
  EXPECT_NEAR(c.normal_p95, 0, 1e-6);
  EXPECT_NEAR(c.flat_normal_p95, 0, 1e-6);
  // Of each face the part 0.03 d from its four edges counts; 4,000 low-discrepancy points.
  EXPECT_NEAR(c.flat_share, std::pow(1 - 0.03 / half.x, 2), 0.01);
  // phi's zero set lies 0.004 d outside the faces, and its corners sqrt 3 times as far from the body's.
  EXPECT_GE(c.hausdorff, offset - 1e-9);
  EXPECT_LE(c.hausdorff, std::sqrt(3.0) * offset + 1e-6);
  EXPECT_EQ(c.volume_error, -1);
}

// A sphere's triangles deviate from the sphere's own normals by a circumradius over the radius at their corners;
// normals interpolated over them are those of the sphere to second order of it.
TEST(CompareNormals, ASphereAgreesWithInterpolatedNormalsAndNotWithTriangles) {
  TriangleMesh const mesh = icosphere(3);  // 1,280 triangles
  AnalyticSdf const sphere{AnalyticKind::sphere, {1, 1, 1}};
  PhiBatch const phi = [&](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    for (int i = 0; i < x.size(); ++i)
      value[i] = signed_distance(sphere, x[i], gradient.empty() ? nullptr : &gradient[i]);
  };
  MeshDistance const distance(mesh);
  NormalComparison const n = compare_normals(phi, truth_of(mesh, distance_of(distance)), {}, 4000);
  // About equilateral triangles of area A = 3 sqrt 3 / 4 R^2 with R their circumradius; half of A lies within
  // sqrt(A / (2 pi)) of the centre, less than R / 2, the inradius. The triangles differ in size by a fifth.
  double const area = 4 * std::numbers::pi / 1280, degree = std::numbers::pi / 180;
  double const farthest = std::sqrt(4 * area / std::sqrt(27.0)) / degree;
  EXPECT_NEAR(n.to_triangles.p50, std::sqrt(area / (2 * std::numbers::pi)) / degree, 0.2);
  EXPECT_GT(n.to_triangles.p95, 0.7 * farthest);
  EXPECT_LT(n.to_triangles.p95, 1.1 * farthest);
  EXPECT_LT(n.to_interpolated.p95, 0.08 * n.to_triangles.p95);
  EXPECT_NEAR(n.triangles_to_interpolated.p95, n.to_triangles.p95, 0.05 * n.to_triangles.p95);
  EXPECT_EQ(n.flat_share, 1);
  EXPECT_EQ(n.to_triangles.flat_p95, n.to_triangles.p95);
}

// A gradient turned by a known angle about the normal's own tangent is that far from every yardstick.
TEST(CompareNormals, ATurnedGradientIsThatFarOff) {
  TriangleMesh const mesh = icosphere(4);
  double constexpr turn = 10 * std::numbers::pi / 180;
  PhiBatch const phi = [&](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    for (int i = 0; i < x.size(); ++i) {
      Vec3 const inward = -normalized(x[i]), tangent = normalized(cross(inward, Vec3{0.3, -0.5, 0.8}));
      value[i] = 1 - norm(x[i]);
      if (!gradient.empty()) gradient[i] = inward * std::cos(turn) + tangent * std::sin(turn);
    }
  };
  MeshDistance const distance(mesh);
  NormalComparison const n = compare_normals(phi, truth_of(mesh, distance_of(distance)), {}, 4000);
  EXPECT_NEAR(n.to_interpolated.p50, 10, 0.1);
  EXPECT_NEAR(n.to_interpolated.p95, 10, 0.3);
  EXPECT_NEAR(n.to_triangles.p50, 10, 0.3);         // the triangles' own deviations, at most 2.5 degrees, to both sides
  EXPECT_LT(n.triangles_to_interpolated.p95, 2.6);  // which the turn leaves alone
}

// Of a box the triangles are the surface, and interpolation rounds its edges off.
TEST(CompareNormals, OfAPolyhedronTheTrianglesAreRight) {
  TriangleMesh const mesh = box_mesh({0.4, 0.4, 0.4});
  MeshDistance const distance(mesh);
  PhiBatch const exact = distance_of(distance);
  NormalComparison const n = compare_normals(exact, truth_of(mesh, exact), {}, 4000);
  EXPECT_NEAR(n.to_triangles.p95, 0, 1e-6);
  EXPECT_GT(n.to_interpolated.p50, 20);
  EXPECT_NEAR(n.to_interpolated.p50, n.triangles_to_interpolated.p50, 1e-6);
}

TEST(Certify, NormalsAtEdgesAreLeftOutOfTheFlatOnes) {
  // The truth is a box; the shape turns its gradient by 90 degrees within 0.02 d of the edges and nowhere else.
  Vec3 const half{0.4, 0.4, 0.4};
  TriangleMesh const mesh = box_mesh(half);
  SegmentDistance const edges(sharp_edges(mesh, std::numbers::pi / 6));
  MeshDistance const distance(mesh);
  PhiBatch const exact = distance_of(distance);
  PhiBatch const phi = [&](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    exact(x, value, gradient);
    for (int i = 0; i < gradient.size(); ++i)
      if (edges(x[i]) < 0.02) gradient[i] = {gradient[i].y, gradient[i].z, gradient[i].x};
  };
  Certificate c;
  certify(phi, truth_of(mesh, exact), {}, 4000, 1, c);
  EXPECT_NEAR(c.normal_p50, 0, 1e-6);
  EXPECT_NEAR(c.normal_p95, 90, 1e-6);  // 1 - (1 - 0.02 / 0.4)^2 = 10 % of the surface
  EXPECT_NEAR(c.flat_normal_p95, 0, 1e-6);
}

TEST(SharpEdges, OfABoxAndOfASphere) {
  std::vector<std::array<Vec3, 2>> const edges = sharp_edges(box_mesh({1, 2, 3}), std::numbers::pi / 6);
  ASSERT_EQ(edges.size(), 12u);  // the diagonals of the faces turn by nothing
  SegmentDistance const distance(edges);
  EXPECT_NEAR(distance({1, 2, 0.5}), 0, 1e-12);
  EXPECT_NEAR(distance({0, 0, 3}), 1, 1e-12);  // the middle of the top: the edges x = +-1
  EXPECT_NEAR(distance({2, 2, 0}), 1, 1e-12);
  EXPECT_TRUE(sharp_edges(icosphere(3), std::numbers::pi / 6).empty());
  EXPECT_EQ(SegmentDistance({})({0, 0, 0}), INFINITY);
}

}  // namespace
}  // namespace scree
