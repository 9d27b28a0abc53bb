// test_mesh.cpp: exact mesh distance, mesh checks and repair, normalisation, form measures, procedural grains.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "shapes/mesh/icosphere.h"
#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh/mesh_measures.h"
#include "shapes/mesh/procedural_grains.h"
#include "shapes/mesh_normalise.h"
#include "shapes/random.h"

namespace scree {
namespace {

// [-1, 1] x [-1, 1] x [-1, 1] scaled by `half` and moved by `at`.
TriangleMesh box_mesh(Vec3 half, Vec3 at = {}) {
  std::vector<Vec3> corner;
  for (int i = 0; i < 8; ++i)
    corner.push_back(at + multiply(half, {i & 1 ? 1.0 : -1, i & 2 ? 1.0 : -1, i & 4 ? 1.0 : -1}));
  return convex_hull(corner);
}

TriangleMesh join(TriangleMesh a, TriangleMesh const& b) {
  int const first = static_cast<int>(a.vertex.size());
  a.vertex.insert(a.vertex.end(), b.vertex.begin(), b.vertex.end());
  for (auto t : b.triangle) a.triangle.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

// Exact for a box (Quilez): outside the distance to the clamped point, inside that to the nearest face.
double box_distance(Vec3 half, Vec3 x) {
  Vec3 const q{std::abs(x.x) - half.x, std::abs(x.y) - half.y, std::abs(x.z) - half.z};
  double const outside = norm(Vec3{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)});
  return -(outside + std::min(std::max({q.x, q.y, q.z}), 0.0));
}

TEST(MeshDistance, EqualsTheClosedFormOfABox) {
  Vec3 const half{0.5, 0.3, 0.2};
  MeshDistance const distance(box_mesh(half));
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Vec3 const x{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    MeshDistance::Sample const s = distance.at(x);
    EXPECT_NEAR(s.phi, box_distance(half, x), 1e-12);  // a few roundings of numbers of order 1
    EXPECT_NEAR(norm(s.gradient), 1, 1e-9);
    EXPECT_NEAR(norm(s.closest - x), std::abs(s.phi), 1e-12);
    double const step = 1e-6;  // phi is 1-Lipschitz with slope 1 along its gradient, towards the inside
    EXPECT_GE(distance.at(x + s.gradient * step).phi, s.phi - step - 1e-12);
    EXPECT_NEAR(distance.at(x - s.gradient * step).phi, s.phi - step, 1e-9);
  }
}

TEST(MeshDistance, OnTheSurfaceTheGradientIsTheInwardNormal) {
  MeshDistance const distance(box_mesh({0.5, 0.5, 0.5}));
  MeshDistance::Sample const s = distance.at({0.5, 0.1, 0.2});
  EXPECT_EQ(s.phi, 0);
  EXPECT_NEAR(norm(s.gradient - Vec3{-1, 0, 0}), 0, 1e-12);
}

TEST(MeshDistance, BatchHasTheSameBitsForAnyThreads) {
  MeshDistance const distance(icosphere(2));
  Random random(2);
  std::vector<Vec3> x;
  for (int i = 0; i < 1000; ++i) x.push_back(random.direction() * random.uniform(0, 2));
  std::vector<double> one(x.size()), two(x.size());
  std::vector<Vec3> gradient(x.size());
  distance.evaluate(x, one, {}, 1);
  distance.evaluate(x, two, gradient, 2);
  EXPECT_EQ(one, two);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(one[i], distance.at(x[i]).phi);
  distance.evaluate({}, {}, {}, 2);  // nothing is legal
  EXPECT_THROW(distance.evaluate(x, Span<double>(one.data(), 3), {}, 1), std::invalid_argument);
}

TEST(MeshDistance, RefusesWhatBoundsNoSolid) {
  TriangleMesh mesh = box_mesh({1, 1, 1});
  mesh.triangle.pop_back();
  EXPECT_THROW(MeshDistance{mesh}, std::invalid_argument);
}

TEST(MeshCheck, NamesEachDefect) {
  TriangleMesh const good = box_mesh({1, 1, 1});
  EXPECT_TRUE(check_mesh(good).defects.empty());

  TriangleMesh open = good;
  open.triangle.pop_back();
  EXPECT_EQ(check_mesh(open).open_edges, 3);

  TriangleMesh inside_out = good;
  for (auto& t : inside_out.triangle) std::swap(t[0], t[1]);
  ASSERT_EQ(check_mesh(inside_out).defects.size(), 1u);
  EXPECT_NE(check_mesh(inside_out).defects[0].find("inside out"), std::string::npos);

  TriangleMesh one_turned = good;
  std::swap(one_turned.triangle[0][0], one_turned.triangle[0][1]);
  EXPECT_EQ(check_mesh(one_turned).misoriented_edges, 3);

  EXPECT_EQ(check_mesh(join(good, box_mesh({1, 1, 1}, {5, 0, 0}))).components, 2);

  TriangleMesh degenerate = good;
  degenerate.triangle.push_back({0, 1, 1});
  EXPECT_FALSE(check_mesh(degenerate).defects.empty());

  // A third sheet on an edge of the box.
  TriangleMesh fin = good;
  fin.vertex.push_back({3, 3, 3});
  fin.triangle.push_back({good.triangle[0][0], good.triangle[0][1], static_cast<int>(fin.vertex.size()) - 1});
  EXPECT_EQ(check_mesh(fin).non_manifold_edges, 1);

  EXPECT_FALSE(check_mesh({}).defects.empty());
}

TEST(MeshCheck, FindsSelfIntersection) {
  // A sphere of which one vertex is pulled through the opposite side.
  TriangleMesh mesh = icosphere(2);
  mesh.vertex[0] = mesh.vertex[0] * -1.5;
  EXPECT_TRUE(check_mesh(mesh).self_intersecting);
  EXPECT_FALSE(check_mesh(icosphere(2)).self_intersecting);
}

TEST(MeshRepair, RestoresTheVolume) {
  TriangleMesh const sphere = icosphere(3);
  double const volume = mesh_mass(sphere).volume;
  // A triangle is missing, two are turned, a small box floats beside it, and every corner has a vertex of its own.
  TriangleMesh broken;
  TriangleMesh const both = join(sphere, box_mesh({0.1, 0.1, 0.1}, {3, 0, 0}));
  for (std::size_t t = 1; t < both.triangle.size(); ++t) {
    std::array<int, 3> corner{};
    for (int k = 0; k < 3; ++k) {
      corner[k] = static_cast<int>(broken.vertex.size());
      broken.vertex.push_back(both.vertex[both.triangle[t][k]]);
    }
    if (t == 100 || t == 200) std::swap(corner[0], corner[1]);
    broken.triangle.push_back(corner);
  }
  EXPECT_FALSE(check_mesh(broken).defects.empty());
  std::vector<std::string> actions;
  TriangleMesh const repaired = repair_mesh(broken, &actions);
  EXPECT_TRUE(check_mesh(repaired).defects.empty());
  EXPECT_GE(actions.size(), 3u);
  // The hole was one triangle, its fill is the same triangle: only the order of sums differs.
  EXPECT_NEAR(mesh_mass(repaired).volume, volume, 1e-12 * volume);
}

TEST(MeshRepair, SaysWhyItCannot) {
  TriangleMesh half;  // a hemisphere: its rim is longer than the holes that are filled
  TriangleMesh const sphere = icosphere(3);
  half.vertex = sphere.vertex;
  for (auto const& t : sphere.triangle)
    if (sphere.vertex[t[0]].z + sphere.vertex[t[1]].z + sphere.vertex[t[2]].z > 0) half.triangle.push_back(t);
  EXPECT_THROW(repair_mesh(half, nullptr, 5), std::runtime_error);
  EXPECT_THROW(repair_mesh({}), std::runtime_error);
}

TEST(MeshNormalise, GivesTheFrameOfShapes) {
  TriangleMesh mesh = box_mesh({1, 2, 3});
  Mat3 const turn = to_matrix(quat_from_rotation_vector({0.3, -0.7, 1.1}));
  for (Vec3& v : mesh.vertex) v = turn * v + Vec3{5, -4, 3};
  MeshMass const mass = mesh_mass(normalised(mesh));
  EXPECT_NEAR(mass.volume, std::numbers::pi / 6, 1e-12);
  EXPECT_NEAR(norm(mass.centroid), 0, 1e-12);
  // Box with edges e = s (6, 4, 2): I = V (e_j^2 + e_k^2) / 12, longest axis along x.
  double const s = std::cbrt(std::numbers::pi / 6 / 48), v = std::numbers::pi / 6;
  EXPECT_NEAR(mass.inertia.row[0].x, v * s * s * (16 + 4) / 12, 1e-12);
  EXPECT_NEAR(mass.inertia.row[1].y, v * s * s * (36 + 4) / 12, 1e-12);
  EXPECT_NEAR(mass.inertia.row[2].z, v * s * s * (36 + 16) / 12, 1e-12);
  EXPECT_NEAR(mass.inertia.row[0].y, 0, 1e-12);
  TriangleMesh inside_out = mesh;
  for (auto& t : inside_out.triangle) std::swap(t[0], t[1]);
  EXPECT_THROW(normalised(inside_out), std::invalid_argument);
}

TEST(MeshMeasures, AgreeWithFormulas) {
  TriangleMesh const box = box_mesh({1.5, 1, 0.5});
  EXPECT_NEAR(convexity(box), 1, 1e-12);
  EXPECT_NEAR(aspect_ratio(box), 3, 1e-9);
  double const v = 3 * 2 * 1, a = 2 * (3 * 2 + 2 * 1 + 3 * 1);
  EXPECT_NEAR(sphericity(box), std::cbrt(36 * std::numbers::pi * v * v) / a, 1e-12);
  std::vector<double> const angles = dihedral_angles(box);
  EXPECT_EQ(angles.size(), 12u);  // a box has twelve edges
  for (double angle : angles) EXPECT_NEAR(angle, std::numbers::pi / 2, 1e-12);
  // Two boxes side by side as one solid's hull: half of it is empty.
  EXPECT_NEAR(convexity(join(box_mesh({1, 1, 1}, {-2, 0, 0}), box_mesh({1, 1, 1}, {2, 0, 0}))), 16.0 / 24, 1e-12);
  // A box sees itself from everywhere; the deepest point is half the thinnest edge from every plane.
  StarKernel const kernel = star_kernel(box, 21);  // odd: the centre is a grid point
  EXPECT_NEAR(kernel.depth, 0.5, 1e-12);
  EXPECT_GE(kernel.certain_below, 0.5);
  EXPECT_THROW(convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), std::invalid_argument);
}

// Planar faces: triangles with one normal count once.
int flat_faces(TriangleMesh const& mesh) {
  std::vector<Vec3> normals;
  for (auto const& [a, b, c] : mesh.triangle) {
    Vec3 const n = normalized(cross(mesh.vertex[b] - mesh.vertex[a], mesh.vertex[c] - mesh.vertex[a]));
    if (std::none_of(normals.begin(), normals.end(), [&](Vec3 m) { return norm(m - n) < 1e-6; })) normals.push_back(n);
  }
  return static_cast<int>(normals.size());
}

class ProceduralGrains : public testing::Test {
 protected:
  static std::vector<ProceduralGrain> const& grains() {
    static std::vector<ProceduralGrain> const all = procedural_grains();
    return all;
  }
};

TEST_F(ProceduralGrains, AreTwentyNormalisedSolids) {
  ASSERT_EQ(grains().size(), 20u);
  std::set<std::string> names;
  for (ProceduralGrain const& g : grains()) {
    names.insert(g.name);
    MeshMass const mass = mesh_mass(g.mesh);
    EXPECT_NEAR(mass.volume, std::numbers::pi / 6, 1e-12) << g.name;
    EXPECT_LT(norm(mass.centroid), 1e-12) << g.name;
    EXPECT_LE(mass.inertia.row[0].x, mass.inertia.row[1].y + 1e-12) << g.name;
    EXPECT_LE(mass.inertia.row[1].y, mass.inertia.row[2].z + 1e-12) << g.name;
    EXPECT_TRUE(check_mesh(g.mesh).defects.empty()) << g.name;
  }
  EXPECT_EQ(names.size(), 20u);
  EXPECT_TRUE(names.count("ballast/0") && names.count("sand/4"));
}

TEST_F(ProceduralGrains, HaveTheFormOfTheirKind) {
  bool not_star_shaped = false;
  for (ProceduralGrain const& g : grains()) {
    std::vector<double> const angles = dihedral_angles(g.mesh);
    if (g.category == "ballast") {
      EXPECT_GE(flat_faces(g.mesh), 12) << g.name;
      EXPECT_GT(*std::min_element(angles.begin(), angles.end()), 30 * std::numbers::pi / 180) << g.name;
      EXPECT_LE(sphericity(g.mesh), 0.88) << g.name;
    } else if (g.category == "sand") {
      EXPECT_LE(convexity(g.mesh), 0.95) << g.name;
      not_star_shaped = not_star_shaped || star_kernel(g.mesh).certain_below < 0;
    } else {
      // Smooth: neighbouring triangles of 0.02 d on radii of curvature above 0.1 d turn by less than 0.2.
      EXPECT_LT(*std::max_element(angles.begin(), angles.end()), 0.2) << g.name;
      EXPECT_GE(convexity(g.mesh), 0.98) << g.name;
    }
  }
  EXPECT_TRUE(not_star_shaped);
}

TEST_F(ProceduralGrains, SpanAspectRatios) {
  for (int kind = 0; kind < 4; ++kind) {
    double low = INFINITY, high = 0;
    for (int i = 0; i < grains_per_kind; ++i) {
      double const ratio = aspect_ratio(grains()[kind * grains_per_kind + i].mesh);
      low = std::min(low, ratio);
      high = std::max(high, ratio);
    }
    EXPECT_GE(high, 1.5) << grains()[kind * grains_per_kind].category;
    EXPECT_GE(high - low, 0.25) << grains()[kind * grains_per_kind].category;
  }
}

TEST_F(ProceduralGrains, RepeatWithTheirSeed) {
  ProceduralGrain const again = procedural_grain(GrainKind::ballast, 0);
  EXPECT_TRUE(again.mesh.vertex == grains()[0].mesh.vertex);
  EXPECT_FALSE(procedural_grain(GrainKind::ballast, 0, 2).mesh.vertex == grains()[0].mesh.vertex);
  EXPECT_THROW(procedural_grain(GrainKind::sand, 5), std::invalid_argument);
}

}  // namespace
}  // namespace scree
