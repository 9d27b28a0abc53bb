// test_reconstruct.cpp: alpha shapes and harmonics meshes of point clouds, and the meter that compares meshes.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shapes/harmonics_fit.h"
#include "shapes/mesh/alpha_shape.h"
#include "shapes/mesh/harmonics_mesh.h"
#include "shapes/mesh/icosphere.h"
#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/mesh_compare.h"
#include "shapes/mesh/mesh_measures.h"
#include "shapes/mesh/procedural_grains.h"
#include "shapes/mesh/untangle.h"
#include "shapes/mesh_samples.h"
#include "shapes/random.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

// Body r(theta) around a bent axis: the crescent that is not star-shaped.
TriangleMesh crescent() { return procedural_grain(GrainKind::sand, 4).mesh; }

TriangleMesh moved(TriangleMesh mesh, Vec3 by) {
  for (Vec3& v : mesh.vertex) v += by;
  return mesh;
}

TEST(Untangle, TakesASpikeBackAndLeavesTheRestAlone) {
  TriangleMesh const ball = icosphere(3);
  TriangleMesh mesh = ball;
  EXPECT_EQ(untangle(mesh).vertices, 0);
  mesh.vertex[0] = ball.vertex[0] * -1.2;  // through the far side, about 2.2 away
  TriangleMesh const spiked = mesh;
  EXPECT_TRUE(check_mesh(mesh).self_intersecting);
  Untangled const u = untangle(mesh);
  EXPECT_TRUE(u.is_simple);
  EXPECT_FALSE(check_mesh(mesh).self_intersecting);
  int changed = 0;
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) changed += !(mesh.vertex[v] == spiked.vertex[v]);
  EXPECT_EQ(changed, u.vertices);
  EXPECT_LT(changed, 40);  // of 642: the spike, its neighbours and the triangles that they pierced
  EXPECT_NEAR(u.farthest, 2.2, 0.1);
  TriangleMesh kept = spiked;
  EXPECT_FALSE(untangle(kept, 0).is_simple);
  EXPECT_TRUE(kept.vertex == spiked.vertex);
}

TEST(MeshCompare, KnowsTheDistanceOfConcentricAndShiftedSpheres) {
  TriangleMesh const ball = icosphere(4);
  TriangleMesh grown = ball;
  for (Vec3& v : grown.vertex) v *= 1.1;
  MeshDifference const d = compare_meshes(grown, ball, 2000);
  // Facets lie below the sphere by at most 1 - cos(half their angular width), here 1.7 degrees.
  double const sagitta = 1 - std::cos(2.2 * std::numbers::pi / 180);
  EXPECT_NEAR(d.hausdorff, 0.1, 2 * sagitta);
  EXPECT_NEAR(d.mean, 0.1, 2 * sagitta);
  EXPECT_NEAR(d.volume_error, 0.331, 1e-12);
  MeshDifference const s = compare_meshes(moved(ball, {0.05, 0, 0}), ball, 2000);
  EXPECT_NEAR(s.hausdorff, 0.05, sagitta);
  EXPECT_NEAR(s.mean, 0.025, sagitta);  // |cos| averages to 1/2 over the sphere
  EXPECT_NEAR(s.volume_error, 0, 1e-12);
  MeshDifference const same = compare_meshes(ball, ball, 500);
  EXPECT_LT(same.hausdorff, 1e-12);
}

TEST(MeshCompare, SeesWhatOnlyOneOfThemHas) {
  TriangleMesh const ball = icosphere(3);
  std::vector<Vec3> point = ball.vertex;
  point.push_back({0, 0, 2});  // a spike on the hull
  MeshDifference const d = compare_meshes(convex_hull(point), ball, 1000);
  EXPECT_NEAR(d.from_mesh, 1, 1e-2);
  EXPECT_LT(d.from_truth, 0.6);
  EXPECT_EQ(d.hausdorff, d.from_mesh);
}

TEST(AlphaShape, OfSurfacePointsAloneIsTheSolidBody) {
  for (TriangleMesh const& body : {crescent(), procedural_grain(GrainKind::ballast, 2).mesh, icosphere(4)}) {
    int const count = 1500;
    AlphaShape const shape = alpha_shape(sample_mesh(body, count).position);
    EXPECT_EQ(shape.parts, 1);
    EXPECT_EQ(shape.points_outside, 0);
    EXPECT_GE(shape.alpha, shape.smallest);
    EXPECT_TRUE(check_mesh(shape.mesh).defects.empty());
    double const spacing = std::sqrt(mesh_mass(body).area / count);
    EXPECT_LT(std::sqrt(shape.alpha), 1.6 * spacing);  // far below the body: voids are filled, not surfaces
    MeshDifference const d = compare_meshes(shape.mesh, body, 2000);
    EXPECT_LT(d.hausdorff, spacing);
    EXPECT_LT(std::abs(d.volume_error), 0.015);
    EXPECT_LT(d.from_mesh, spacing);
  }
}

TEST(AlphaShape, LargeAlphaIsTheHullAndTooSmallAnAlphaIsReported) {
  std::vector<Vec3> const point = sample_mesh(crescent(), 600).position;
  AlphaShape const hull = alpha_shape(point, 1e6);
  EXPECT_NEAR(mesh_mass(hull.mesh).volume, mesh_mass(convex_hull(point)).volume, 1e-12);
  AlphaShape const chosen = alpha_shape(point);
  EXPECT_LT(mesh_mass(chosen.mesh).volume, 0.95 * mesh_mass(hull.mesh).volume);
  AlphaShape const small = alpha_shape(point, 0.2 * chosen.smallest);
  EXPECT_GT(small.points_outside + small.parts, 1);
  EXPECT_EQ(small.smallest, chosen.smallest);
}

TEST(AlphaShape, TwoBallsAreTwoPartsUntilTheBallCannotPass) {
  TriangleMesh const ball = icosphere(2);  // points 0.3 apart
  std::vector<Vec3> point = ball.vertex;
  for (Vec3 const& v : ball.vertex) point.push_back(v + Vec3{4, 0, 0});
  AlphaShape const apart = alpha_shape(point, 0.25);
  EXPECT_EQ(apart.parts, 2);
  EXPECT_EQ(apart.points_outside, 0);
  EXPECT_NEAR(mesh_mass(apart.mesh).volume, 2 * mesh_mass(ball).volume, 1e-9);
  AlphaShape const together = alpha_shape(point);
  EXPECT_EQ(together.parts, 1);
  EXPECT_TRUE(check_mesh(together.mesh).defects.empty());
}

TEST(AlphaShape, InteriorPointsAndDuplicatesChangeNothing) {
  TriangleMesh const ball = icosphere(3);
  std::vector<Vec3> point = ball.vertex;
  AlphaShape const alone = alpha_shape(point);
  Random random(3);
  for (int i = 0; i < 200; ++i) point.push_back(random.direction() * random.uniform(0, 0.7));
  point.push_back(point[0]);
  AlphaShape const filled = alpha_shape(point);
  EXPECT_EQ(filled.points_outside, 0);
  EXPECT_EQ(filled.mesh.triangle.size(), alone.mesh.triangle.size());
  EXPECT_NEAR(mesh_mass(filled.mesh).volume, mesh_mass(ball).volume, 1e-9);
}

TEST(AlphaShape, DegenerateCloudsAreRefused) {
  EXPECT_THROW(alpha_shape({}), std::invalid_argument);
  EXPECT_THROW(alpha_shape({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), std::invalid_argument);
  EXPECT_THROW(alpha_shape({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}), std::invalid_argument);
  EXPECT_THROW(alpha_shape({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, NAN}}), std::invalid_argument);
  EXPECT_EQ(alpha_shape({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}).mesh.triangle.size(), 4u);
}

TEST(HarmonicsMesh, IsAClosedMeshOfTheFittedBody) {
  std::vector<Vec3> point = quasi_uniform_directions(800);
  Vec3 const a{1, 0.9, 0.7};
  for (Vec3& x : point) x *= 1 / norm(divide(x, a));
  TriangleMesh const mesh = harmonics_mesh(fit_harmonics(point, 10).coefficient, 2000);
  EXPECT_EQ(mesh.vertex.size(), 2000u);
  EXPECT_EQ(mesh.triangle.size(), 3996u);
  EXPECT_TRUE(check_mesh(mesh).defects.empty());
  for (Vec3 const& v : mesh.vertex) EXPECT_NEAR(norm(divide(v, a)), 1, 2e-4);  // what degree 10 leaves of a 1:0.7 body
  // Chords of 2,000 vertices: 4 pi / 2000 / 8 of the radius squared off, a little more at curved ends.
  EXPECT_NEAR(mesh_mass(mesh).volume / (4 * std::numbers::pi / 3 * a.x * a.y * a.z), 1, 4e-3);
  EXPECT_THROW(harmonics_mesh({1, 2}, 100), std::invalid_argument);
  EXPECT_THROW(harmonics_mesh({-1}, 100), std::invalid_argument);
  EXPECT_THROW(harmonics_mesh({1}, 3), std::invalid_argument);
}

}  // namespace
}  // namespace scree
