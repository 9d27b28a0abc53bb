// test_surface_nodes.cpp: the gates of the node sets: blind gap, areas, blocks, core nodes, determinism.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "shapes/analytic_shapes.h"
#include "shapes/mesh_shape.h"
#include "shapes/nearest_site.h"
#include "shapes/point_blocks.h"
#include "shapes/support_points.h"
#include "shapes/surface_nodes.h"
#include "tests/support/solids.h"

namespace scree {
namespace {

double constexpr pi = std::numbers::pi;

// The physics' gates that hold for every node set.
void expect_sound(SurfaceNodes const& nodes, PhiBatch const& phi, double volume, int count) {
  EXPECT_GE(nodes.n_surface, 0.97 * count);
  EXPECT_LE(nodes.n_surface, 1.05 * count + 20);
  ASSERT_EQ(nodes.position.size(), nodes.area.size());
  ASSERT_EQ(nodes.position.size(), nodes.normal.size());
  Vec3 sum;
  double flux = 0, total = 0;
  for (int a = 0; a < nodes.n_surface; ++a) {
    EXPECT_GT(nodes.area[a], 0);
    EXPECT_NEAR(norm(nodes.normal[a]), 1, 1e-12);
    sum += nodes.normal[a] * nodes.area[a];
    flux += nodes.area[a] * dot(nodes.position[a], nodes.normal[a]);
    total += nodes.area[a];
  }
  EXPECT_NEAR(norm(sum), 0, 1e-12);  // solved for: rounding of a few thousand terms
  EXPECT_NEAR(flux, 3 * volume, 1e-12);
  EXPECT_NEAR(nodes.spacing, std::sqrt(total / nodes.n_surface), 1e-14);
  std::vector<double> value(nodes.n_surface);
  phi({nodes.position.data(), nodes.n_surface}, value, {});
  for (double v : value) EXPECT_NEAR(v, 0, 1e-6);  // on the surface; float networks keep 1e-7
}

void expect_blocks(SurfaceNodes const& nodes) {
  ASSERT_EQ(nodes.block_first.size(), nodes.block_centre.size() + 1);
  EXPECT_EQ(nodes.block_first.front(), 0);
  EXPECT_EQ(nodes.block_first.back(), static_cast<int>(nodes.position.size()));
  EXPECT_TRUE(std::count(nodes.block_first.begin(), nodes.block_first.end(), nodes.n_surface));  // core: own blocks
  double radius = 0;
  for (std::size_t b = 0; b < nodes.block_centre.size(); ++b) {
    EXPECT_LE(nodes.block_first[b + 1] - nodes.block_first[b], nodes_per_block);
    for (int i = nodes.block_first[b]; i < nodes.block_first[b + 1]; ++i)
      EXPECT_LE(norm(nodes.position[i] - nodes.block_centre[b]), nodes.block_radius[b]);
    if (nodes.block_first[b] < nodes.n_surface) radius += nodes.block_radius[b];
  }
  // Compact: 32 nodes of a flat patch lie in a disc of radius 1.25 to 2 square roots of their area; edges stretch it.
  double const blocks = (nodes.n_surface + nodes_per_block - 1) / nodes_per_block;
  EXPECT_LT(radius / blocks, 1.3 * std::sqrt(nodes_per_block) * nodes.spacing);
}

void expect_core(SurfaceNodes const& nodes) {
  int const core = static_cast<int>(nodes.position.size()) - nodes.n_surface;
  EXPECT_EQ(core, (nodes.n_surface + 3) / 4 + 1);
  double total = 0, core_total = 0;
  int centres = 0;
  for (int a = 0; a < nodes.n_surface; ++a) total += nodes.area[a];
  for (int a = nodes.n_surface; a < static_cast<int>(nodes.position.size()); ++a) {
    EXPECT_EQ(norm(nodes.normal[a]), 0);
    if (norm(nodes.position[a]) == 0) {
      ++centres;
      EXPECT_NEAR(nodes.area[a], total, 1e-12);
      continue;
    }
    core_total += nodes.area[a];
    bool found = false;  // half a surface node's position, four times its area
    for (int s = 0; s < nodes.n_surface && !found; ++s)
      found = nodes.position[a] == nodes.position[s] * 0.5 && nodes.area[a] == nodes.area[s] * 4;
    EXPECT_TRUE(found);
  }
  EXPECT_EQ(centres, 1);
  // Every fourth node in k-d order samples the areas evenly: a quarter of 250 areas that differ by their own size.
  EXPECT_NEAR(core_total, total, 0.25 * total);
}

struct Gate {
  int count;
  double gap;  // [d]
};

// 4,000 nodes: the design's gate. Fewer: what the spacing allows, a disc of radius 0.62 s on R = d/2 sinks by 0.38 s^2
// (s^2 = area / count), times 2 for uneven cells, plus the tolerance below which no node is spent on a corner.
double allowed_gap(int count, double area) { return count >= 4000 ? 3e-3 : 1e-3 + 0.8 * area / count; }

// Half-way from a ring to its centre is the hole, where another ring may hang: no core node may stand there.
TEST(CoreNodes, StandInsideTheBody) {
  Library library;
  auto const circle = [](double u) { return Vec3{std::cos(2 * M_PI * u), 0, std::sin(2 * M_PI * u)}; };
  add_mesh_shape(library, "ring", scree::testing::tube(circle, 0.2, 48, 16, true));
  auto const arc = [](double u) { return Vec3{std::cos(4 * u), 0, std::sin(4 * u)}; };
  add_mesh_shape(library, "hook", scree::testing::tube(arc, 0.3, 48, 16, false));
  for (Shape const& shape : library.shape) {
    SurfaceNodes const nodes = make_surface_nodes(library, shape, 400);
    for (std::size_t a = nodes.n_surface; a < nodes.position.size(); ++a)
      EXPECT_GT(evaluate_reference(library, shape, nodes.position[a]), 0) << shape.name;
    EXPECT_EQ(nodes.block_first.back(), static_cast<int>(nodes.position.size()));
  }
}

class AnalyticNodes : public ::testing::TestWithParam<char const*> {};

TEST_P(AnalyticNodes, GatesHoldAtEveryCount) {
  Library const library;
  Shape const shape = builtin_shape(GetParam());
  PhiBatch const phi = reference_phi(library, shape);
  for (int count : {250, 1000, 4000}) {
    SCOPED_TRACE(count);
    SurfaceNodes const nodes = make_surface_nodes(library, shape, count);
    expect_sound(nodes, phi, shape.volume, count);
    expect_blocks(nodes);
    if (count == 250) expect_core(nodes);
    EXPECT_GE(nodes.largest_gap, 0);
    EXPECT_LE(nodes.largest_gap, allowed_gap(count, shape.area));
    // The meter against the closed form, in directions of the test's own.
    double worst = 0;
    for (Vec3 d : quasi_uniform_directions(777, 0.5)) {
      double reach = -1;
      for (int a = 0; a < nodes.n_surface; ++a) reach = std::max(reach, dot(d, nodes.position[a]));
      worst = std::max(worst, support(shape.analytic, d, nullptr) - reach);
    }
    EXPECT_LE(worst, allowed_gap(count, shape.area));
    EXPECT_NEAR(worst, nodes.largest_gap, 0.5 * allowed_gap(count, shape.area));
  }
}
INSTANTIATE_TEST_SUITE_P(Shapes, AnalyticNodes,
                         ::testing::Values("sphere", "ellipsoid:1:0.7:0.5", "superellipsoid:1:0.8:0.6:0.5",
                                           "superellipsoid:1:0.8:0.6:0.2", "superellipsoid:1:0.8:0.6:1.4", "box:1:1:1",
                                           "box:1:0.5:0.25"));

TEST(SurfaceNodes, BoxKeepsItsFacesEdgesAndCorners) {
  Library const library;
  for (Vec3 edges : {Vec3{1, 1, 1}, Vec3{1, 0.5, 0.25}}) {
    Shape const box = make_box(edges);
    Vec3 const h = box.analytic.half_size;
    SurfaceNodes const nodes = make_surface_nodes(library, box, 4000);
    // Area of each of the six faces: what its nodes and its rim project onto it.
    for (int k = 0; k < 3; ++k)
      for (double side : {-1.0, 1.0}) {
        double area = 0;
        for (int a = 0; a < nodes.n_surface; ++a) area += nodes.area[a] * std::max(0.0, side * nodes.normal[a][k]);
        double const expected = 4 * h.x * h.y * h.z / h[k];
        EXPECT_NEAR(area, expected, 0.01 * expected);
      }
    // A node on every corner, and along every edge 2 % d apart on average, 4 % at most.
    for (int c = 0; c < 8; ++c) {
      Vec3 const corner = multiply(h, {c & 1 ? 1.0 : -1.0, c & 2 ? 1.0 : -1.0, c & 4 ? 1.0 : -1.0});
      double nearest = 1;
      for (int a = 0; a < nodes.n_surface; ++a) nearest = std::min(nearest, norm(nodes.position[a] - corner));
      EXPECT_LT(nearest, 1e-4);
    }
    for (int along = 0; along < 3; ++along)
      for (int c = 0; c < 4; ++c) {
        int const u = (along + 1) % 3, v = (along + 2) % 3;
        std::vector<double> at;
        for (int a = 0; a < nodes.n_surface; ++a) {
          Vec3 const p = nodes.position[a];
          double const du = p[u] - (c & 1 ? h[u] : -h[u]), dv = p[v] - (c & 2 ? h[v] : -h[v]);
          if (std::hypot(du, dv) < 1e-4) at.push_back(p[along]);
        }
        std::sort(at.begin(), at.end());
        double widest = 0;
        for (std::size_t i = 1; i < at.size(); ++i) widest = std::max(widest, at[i] - at[i - 1]);
        EXPECT_LE(widest, 0.04) << "edge along " << along;
        double const mean = 2 * h[along] / static_cast<double>(at.size() - 1);
        EXPECT_LE(mean, 0.02);
      }
  }
}

TEST(SurfaceNodes, SphereIsEven) {
  Library const library;
  SurfaceNodes const nodes = make_surface_nodes(library, make_sphere(), 1000);
  double total = 0;
  for (int a = 0; a < nodes.n_surface; ++a) {
    total += nodes.area[a];
    EXPECT_NEAR(dot(nodes.normal[a], nodes.position[a]), 0.5, 2e-3);  // the cell's mean normal, a few degrees at most
    EXPECT_GT(nodes.area[a], 0.4 * pi / nodes.n_surface);
    EXPECT_LT(nodes.area[a], 1.8 * pi / nodes.n_surface);
  }
  EXPECT_NEAR(total, pi, 2e-3 * pi);
}

// Two balls melted together: a waist, so not convex; exact gradient. Centred on the x axis, symmetric.
void peanut(Span<const Vec3> x, Span<double> phi, Span<Vec3> gradient) {
  for (int i = 0; i < x.size(); ++i) {
    double constexpr k = 40;  // sharpness of the smooth union
    Vec3 const p = x[i] - Vec3{0.25, 0, 0}, q = x[i] + Vec3{0.25, 0, 0};
    double const u = 0.35 - norm(p), v = 0.35 - norm(q), m = std::max(u, v);
    double const a = std::exp(k * (u - m)), b = std::exp(k * (v - m));
    phi[i] = m + std::log((a + b)) / k;
    if (!gradient.empty())
      gradient[i] = p * (-a / (a + b) / std::max(norm(p), 1e-9)) + q * (-b / (a + b) / std::max(norm(q), 1e-9));
  }
}

TEST(SurfaceNodes, ConcaveBodyFromACallback) {
  Shape shape;
  shape.bounding_radius = 0.62;
  shape.lipschitz = 1;
  ZeroSet const set = find_zero_set(peanut, {0.65, 40, 1});
  shape.volume = zero_set_mass(peanut, set).volume;
  SurfaceNodes const nodes = make_surface_nodes(peanut, shape, 4000);
  expect_sound(nodes, peanut, shape.volume, 4000);
  expect_blocks(nodes);
  EXPECT_LE(nodes.largest_gap, 3e-3);
  int waist = 0;  // the waist, too, carries nodes: no spacing is larger than three times the typical one
  for (int a = 0; a < nodes.n_surface; ++a) waist += std::abs(nodes.position[a].x) < 0.05;
  EXPECT_GT(waist, 0.02 * nodes.n_surface);
}

TEST(SurfaceNodes, ThinPlateKeepsItsTwoSidesApart) {
  // 1:1:0.1 with 100 nodes, thinner than their spacing: each side keeps its own nodes and areas.
  Library const library;
  Shape const plate = make_box({1, 1, 0.1});
  SurfaceNodes const nodes = make_surface_nodes(library, plate, 100);
  expect_sound(nodes, reference_phi(library, plate), plate.volume, 100);
  Vec3 const h = plate.analytic.half_size;
  double up = 0, down = 0;
  for (int a = 0; a < nodes.n_surface; ++a) (nodes.normal[a].z > 0 ? up : down) += nodes.area[a] * nodes.normal[a].z;
  EXPECT_NEAR(up, 4 * h.x * h.y, 0.01 * up);
  EXPECT_NEAR(down, -4 * h.x * h.y, -0.01 * down);
}

TEST(SurfaceNodes, SameBitsEveryTime) {
  Library const library;
  Shape const shape = builtin_shape("superellipsoid:1:0.8:0.6:0.3");
  SurfaceNodes const a = make_surface_nodes(library, shape, 1000), b = make_surface_nodes(library, shape, 1000);
  ASSERT_EQ(a.position.size(), b.position.size());
  EXPECT_EQ(0, std::memcmp(a.position.data(), b.position.data(), a.position.size() * sizeof(Vec3)));
  EXPECT_EQ(0, std::memcmp(a.area.data(), b.area.data(), a.area.size() * sizeof(double)));
}

TEST(SurfaceNodes, GapMeterSeesAMissingCorner) {
  Library const library;
  Shape const box = make_box({1, 1, 1});
  PhiBatch const phi = surface_phi(library, box);
  SurfaceNodes nodes = make_surface_nodes(library, box, 1000);
  DenseSurface const dense = make_dense_surface(phi, box, 20000);
  EXPECT_LE(largest_gap(phi, dense.position, 0.01, nodes), 1e-3);
  // Move every node near one corner to the centre: the meter must read what is cut off there.
  Vec3 const corner = box.analytic.half_size;
  for (int a = 0; a < nodes.n_surface; ++a)
    if (norm(nodes.position[a] - corner) < 0.1) nodes.position[a] = {};
  EXPECT_GT(largest_gap(phi, dense.position, 0.01, nodes), 0.04);  // 0.1 / sqrt(3) along the diagonal, at least
  EXPECT_LT(largest_gap(phi, dense.position, 0.01, nodes), 0.11);
}

TEST(SurfaceNodes, DenseSurfaceCoversTheBody) {
  Library const library;
  for (char const* spec : {"sphere", "superellipsoid:1:0.8:0.6:0.3", "box:1:0.5:0.25"}) {
    Shape const shape = builtin_shape(spec);
    DenseSurface const dense = make_dense_surface(surface_phi(library, shape), shape, 50000);
    EXPECT_GE(dense.position.size(), 50000u);
    double area = 0, worst = 0, gap = 0;
    for (std::size_t i = 0; i < dense.position.size(); ++i) {
      area += dense.area[i];
      worst = std::max(worst, std::abs(evaluate_reference(library, shape, dense.position[i])));
    }
    std::vector<Vec3> const direction = quasi_uniform_directions(500, 0.7);
    std::vector<int> const top = extreme_points(dense.position, direction);
    for (std::size_t k = 0; k < direction.size(); ++k)
      gap = std::max(gap, support(shape.analytic, direction[k], nullptr) - dot(direction[k], dense.position[top[k]]));
    EXPECT_NEAR(area, shape.area, 2e-3 * shape.area) << spec;  // inscribed triangles, corners cut by one of them
    EXPECT_LT(worst, 1e-5) << spec;
    EXPECT_LT(gap, 5e-4) << spec;  // a sixth of the nodes' gate
  }
}

TEST(SurfaceNodes, TooFewNodesAreRefused) {
  EXPECT_THROW(make_surface_nodes(Library{}, make_sphere(), 3), std::invalid_argument);
}

TEST(PointBlocks, FullCompactAndEnclosing) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int n : {0, 1, 31, 32, 33, 1000}) {
    std::vector<Vec3> point(n);
    for (Vec3& p : point) p = {number(random), number(random), number(random)};
    PointBlocks const blocks = make_point_blocks(point, 32);
    std::vector<int> seen(blocks.order);
    std::sort(seen.begin(), seen.end());
    for (int i = 0; i < n; ++i) EXPECT_EQ(seen[i], i);
    ASSERT_EQ(blocks.first.size(), blocks.centre.size() + 1);
    EXPECT_EQ(static_cast<int>(blocks.centre.size()), (n + 31) / 32);
    for (std::size_t b = 0; b < blocks.centre.size(); ++b)
      for (int i = blocks.first[b]; i < blocks.first[b + 1]; ++i)
        EXPECT_LE(norm(point[blocks.order[i]] - blocks.centre[b]), blocks.radius[b]);
  }
}

TEST(NearestSite, EqualsBruteForce) {
  std::mt19937 random(5);
  std::normal_distribution<double> number;
  auto const unit = [&] { return normalized(Vec3{number(random), number(random), number(random)}); };
  std::vector<Vec3> site, normal;
  for (int i = 0; i < 500; ++i) {
    normal.push_back(unit());
    site.push_back(multiply(normal.back(), {0.9, 0.5, 0.05}));
  }
  for (double spacing : {0.01, 0.1, 3.0}) {
    NearestSite const nearest(site, normal, spacing);
    for (int q = 0; q < 500; ++q) {
      Vec3 const n = unit(), x = multiply(n, {0.95, 0.52, 0.08});
      int expected = -1;
      double best2 = INFINITY;
      for (int i = 0; i < 500; ++i)
        if (dot(normal[i], n) >= -0.2 && norm2(site[i] - x) < best2) best2 = norm2(site[i] - x), expected = i;
      EXPECT_EQ(nearest.find(x, n), expected);
    }
    EXPECT_GE(nearest.find({5, 5, 5}, {0, 0, 1}), 0);  // far outside the grid
  }
  EXPECT_EQ(NearestSite({{0, 0, 0}}, {{0, 0, 1}}, 0.1).find({0, 0, -1}, {0, 0, -1}), 0);  // only one, facing away
  EXPECT_EQ(NearestSite({}, {}, 0.1).find({}, {0, 0, 1}), -1);
}

}  // namespace
}  // namespace scree
