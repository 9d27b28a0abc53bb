// test_compact_grain.cpp: directions, ray search, mass, and compact nodes, on bodies with closed forms and on the
// shipped decoder.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "shapes/analytic_shapes.h"
#include "shapes/compact_grain.h"
#include "shapes/compact_nodes.h"
#include "shapes/model_file.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

double const pi = 3.141592653589793;

Library const& grains() {
  static Library const library = read_model(std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5");
  return library;
}
CompactGrainMaker const& maker() {
  static CompactGrainMaker const made(grains(), 0, 1000);
  return made;
}

// An analytic body turned, moved and scaled: what a decoder's own frame may look like.
struct Placed {
  Shape shape;
  Mat3 rotation = to_matrix(normalized(Quat{0.3, -0.5, 0.7, 0.2}));  // body -> raw
  Vec3 shift{0.03, -0.05, 0.02};
  double scale = 0.8;

  PhiBatch phi() const {
    return [this](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
      for (int i = 0; i < x.size(); ++i) {
        Vec3 const at = transposed_times(rotation, x[i] - shift) / scale;
        value[i] = scale * signed_distance(shape.analytic, at, gradient.empty() ? nullptr : &gradient[i]);
        if (!gradient.empty()) gradient[i] = rotation * gradient[i];
      }
    };
  }
};

TEST(DirectionSet, CellsFillTheSphereAndAreAlike) {
  for (int n : {16, 250, 1000}) {
    DirectionSet const set = make_direction_set(n);
    double total = 0, least = 9, most = 0;
    Vec3 sum;
    for (int i = 0; i < n; ++i) {
      EXPECT_NEAR(norm(set.direction[i]), 1, 1e-14);
      total += set.solid_angle[i];
      sum += set.direction[i] * set.solid_angle[i];
      least = std::min(least, set.solid_angle[i]), most = std::max(most, set.solid_angle[i]);
    }
    EXPECT_NEAR(total, 4 * pi, 1e-11);
    EXPECT_LT(norm(sum), 0.05 / std::sqrt(n));  // centroidal cells balance
    EXPECT_LT(most / least, 1.5);
  }
}

// Delaunay by brute force: no direction lies in the cap of a triangle; and the rings are a closed orientable surface.
TEST(DirectionSet, RingsAreTheDelaunayTriangulation) {
  DirectionSet const set = make_direction_set(60);
  int triangles = 0;
  for (int i = 0; i < 60; ++i) {
    int const begin = set.ring_first[i], end = set.ring_first[i + 1];
    for (int k = begin; k < end; ++k) {
      int const a = set.neighbour[k], b = set.neighbour[k + 1 < end ? k + 1 : begin];
      Vec3 const p = set.direction[i];
      Vec3 const n = normalized(cross(set.direction[a] - p, set.direction[b] - p));
      ASSERT_GT(dot(n, p), 0) << "clockwise";
      for (int j = 0; j < 60; ++j) {
        if (j == i || j == a || j == b) continue;
        ASSERT_LT(dot(n, set.direction[j]), dot(n, p)) << i << " " << a << " " << b;
      }
      ++triangles;
    }
  }
  EXPECT_EQ(triangles, 3 * (2 * 60 - 4));
}

TEST(DirectionSet, RefusesCountsItCannotServe) {
  EXPECT_THROW(make_direction_set(15), std::invalid_argument);
  EXPECT_THROW(make_direction_set(20001), std::invalid_argument);
}

TEST(CompactGrain, AnalyticBodiesKeepTheirMassFrameAndBounds) {
  struct Row {
    char const* shape;
    double volume, inertia, area;  // tolerances
  };
  // Smooth bodies converge fast; exponent 0.5 has blunt edges, on which the quadrature's errors are of the cell's size.
  for (Row const& row : {Row{"sphere", 1e-5, 1e-5, 1e-5}, Row{"ellipsoid:1:0.7:0.5", 1e-5, 1e-5, 1e-5},
                         Row{"superellipsoid:1:0.8:0.6:0.5", 1e-4, 2e-4, 2e-3}}) {
    Placed body{builtin_shape(row.shape)};
    CompactGrain grain;
    ASSERT_EQ(make_compact_grain(body.phi(), 1.0, 1, maker().directions(), grain), GrainFault::none) << row.shape;
    EXPECT_NEAR(std::pow(grain.query.scale / body.scale, 3), 1, row.volume) << row.shape;
    EXPECT_LT(norm(grain.query.shift - body.shift), row.volume) << row.shape;
    EXPECT_NEAR(grain.area / body.shape.area, 1, row.area) << row.shape;
    EXPECT_NEAR(grain.bounding_radius, body.shape.bounding_radius, 2e-3) << row.shape;
    EXPECT_GT(grain.bounding_radius, body.shape.bounding_radius - 1e-6) << row.shape;
    // A formula's body has its own order of axes; inertias come in ascending order.
    Vec3 want = body.shape.inertia;
    double* const w = &want.x;
    std::sort(w, w + 3);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(grain.inertia[k] / want[k], 1, row.inertia) << row.shape;
    EXPECT_GE(grain.lipschitz, 1);
  }
}

// The fast path against normalise_net, by which the library was made: 48-cell zero sets, extrapolated.
TEST(CompactGrain, ShippedGrainsAgreeWithTheirNormalisation) {
  double worst_volume = 0, worst_inertia = 0, worst_area = 0;
  int made = 0;
  for (Shape const& s : grains().shape) {
    CompactGrain grain;
    GrainFault const fault = maker().make(s.code, grain);
    if (s.name == "sand/4") {  // a crescent
      EXPECT_EQ(fault, GrainFault::not_star_shaped);
      continue;
    }
    ASSERT_EQ(fault, GrainFault::none) << s.name << ": " << to_string(fault);
    ++made;
    worst_volume = std::max(worst_volume, std::abs(std::pow(grain.query.scale / s.query.scale, 3) - 1));
    for (int k = 0; k < 3; ++k) worst_inertia = std::max(worst_inertia, std::abs(grain.inertia[k] / s.inertia[k] - 1));
    worst_area = std::max(worst_area, std::abs(grain.area / s.area - 1));
    EXPECT_LT(norm(grain.query.shift - s.query.shift), 3e-4) << s.name;  // rays cut corners: with them goes volume
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(grain.box.min[k], s.box.min[k] + 2e-3) << s.name;
      EXPECT_GT(grain.box.max[k], s.box.max[k] - 2e-3) << s.name;
    }
    EXPECT_GT(grain.bounding_radius, s.bounding_radius - 1e-3) << s.name;
  }
  EXPECT_EQ(made, 19);
  printf("19 grains: volume to %.1e, inertia to %.1e, area to %.1e\n", worst_volume, worst_inertia, worst_area);
  EXPECT_LT(worst_volume, 3e-4);
  EXPECT_LT(worst_inertia, 1e-3);
  EXPECT_LT(worst_area, 1e-2);
}

TEST(CompactGrain, NodesLieOnTheSurfaceAndTheirAreasClose) {
  for (int of : {0, 7, 12, 18}) {
    Shape const& s = grains().shape[of];
    CompactGrain grain;
    ASSERT_EQ(maker().make(s.code, grain), GrainFault::none);
    Shape const made = to_shape(grain, s.net, s.code, "made");
    SurfaceNodes const nodes = explicit_nodes(grain, maker().directions());
    ASSERT_EQ(nodes.n_surface, 1000);
    ASSERT_EQ(nodes.position.size(), 1000u + 250u + 1u);
    Vec3 closure;
    double flux = 0, total = 0;
    for (int k = 0; k < nodes.n_surface; ++k) {
      // 3e-6 of the search, 4e-6 of the 16 bits, a little float noise of the network.
      EXPECT_LT(std::abs(evaluate_reference(grains(), made, nodes.position[k])), 1e-5) << s.name;
      EXPECT_LE(norm(nodes.position[k]), grain.bounding_radius);
      closure += nodes.normal[k] * nodes.area[k];
      flux += nodes.area[k] * dot(nodes.normal[k], nodes.position[k]);
      total += nodes.area[k];
    }
    EXPECT_LT(norm(closure), 1e-6);
    EXPECT_NEAR(flux / (3 * s.volume), 1, 1e-6);
    EXPECT_NEAR(total / grain.area, 0.98, 0.025);  // a node on an edge has the length of the mean of two faces' areas
    for (std::size_t k = 0; k < 250; ++k) {
      EXPECT_EQ(nodes.position[1000 + k], nodes.position[4 * k] * 0.5);
      EXPECT_EQ(nodes.area[1000 + k], nodes.area[4 * k] * 4);
    }
    EXPECT_EQ(nodes.position.back(), Vec3{});
    EXPECT_NEAR(nodes.area.back() / total, 1, 1e-6);
  }
}

TEST(CompactGrain, SixteenBitsCostLessThanFourMillionthsOfADiameter) {
  Placed body{builtin_shape("ellipsoid:1:0.9:0.8")};
  DirectionSet const& set = maker().directions();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.75, 1.25);  // wider than any shipped grain's, which is 0.7 .. 1.2
  Rays rays{{0.01, 0.02, -0.03}, {{{0.6, 0, 0}, {0, 0.5, 0}, {0, 0, 0.42}}}};
  std::vector<double> radius(set.count());
  for (double& r : radius) r = u(random);
  CompactGrain grain;
  encode_nodes(rays, set, radius, grain);
  SurfaceNodes const nodes = explicit_nodes(grain, set);
  double worst = 0;
  for (int i = 0; i < set.count(); ++i)
    worst = std::max(worst, norm(nodes.position[i] - rays.at(set.direction[i], radius[i])));
  EXPECT_LT(worst, 4e-6);
  EXPECT_GT(worst, 1e-7);  // it is 16 bits that are tested
}

// Brute force: every node lies in its block's ball, and in no other block; every node has a block.
TEST(CompactGrain, BlocksHoldTheirNodes) {
  for (int n : {16, 100, 250, 1000}) {
    DirectionSet const set = make_direction_set(n);
    Placed const body{builtin_shape("superellipsoid:1:0.6:0.4:0.4")};
    CompactGrain grain;
    ASSERT_EQ(make_compact_grain(body.phi(), 1.2, 1, set, grain), GrainFault::none) << n;
    SurfaceNodes const nodes = explicit_nodes(grain, set);
    EXPECT_EQ(nodes.block_first.back(), static_cast<int>(nodes.position.size()));
    double loosest = 0;
    for (std::size_t b = 0; b + 1 < nodes.block_first.size(); ++b) {
      EXPECT_GT(nodes.block_first[b + 1], nodes.block_first[b]);
      EXPECT_LE(nodes.block_first[b + 1] - nodes.block_first[b], nodes_per_block);
      double far = 0;
      for (int k = nodes.block_first[b]; k < nodes.block_first[b + 1]; ++k)
        far = std::max(far, norm(nodes.position[k] - nodes.block_centre[b]));
      EXPECT_LE(far, nodes.block_radius[b]) << "block " << b << " of " << n;
      loosest = std::max(loosest, nodes.block_radius[b] - far);
    }
    EXPECT_LT(loosest, 1.01 / 255 * 0.9);  // a byte's step of the largest ball
  }
}

TEST(CompactGrain, RefusesWhatRaysCannotDescribe) {
  DirectionSet const& set = maker().directions();
  CompactGrain grain;
  auto const fault_of = [&](auto const& value) {
    return make_compact_grain(
        [&](Span<const Vec3> x, Span<double> phi, Span<Vec3> gradient) {
          double const h = 1e-6;
          for (int i = 0; i < x.size(); ++i) {
            phi[i] = value(x[i]);
            for (int k = 0; k < 3 && !gradient.empty(); ++k) {
              Vec3 e;
              e[k] = h;
              gradient[i][k] = (value(x[i] + e) - value(x[i] - e)) / (2 * h);
            }
          }
        },
        1.0, 1, set, grain);
  };
  auto const ball = [](Vec3 x, Vec3 c, double r) { return r - norm(x - c); };
  EXPECT_EQ(fault_of([&](Vec3 x) { return ball(x, {}, 0.5); }), GrainFault::none);
  EXPECT_EQ(fault_of([&](Vec3 x) { return ball(x, {}, 0.5) - 2; }), GrainFault::no_surface);
  EXPECT_EQ(fault_of([&](Vec3 x) { return ball(x, {}, 1.5); }), GrainFault::outside_ball);
  // A void inside, a satellite beside a rod (beyond the bounding sphere there is nothing, by definition), and a cave.
  EXPECT_EQ(fault_of([&](Vec3 x) {
              return std::min(ball(x, {}, 0.5), -ball(x, {0.3, 0, 0}, 0.1));
            }),
            GrainFault::not_star_shaped);
  auto const rod = [&](Vec3 x) { return ball(x, {std::clamp(x.x, -0.35, 0.35), 0, 0}, 0.2); };
  EXPECT_EQ(fault_of(rod), GrainFault::none);
  EXPECT_EQ(fault_of([&](Vec3 x) {
              return std::max(rod(x), ball(x, {0, 0.42, 0}, 0.1));
            }),
            GrainFault::not_star_shaped);
  EXPECT_EQ(fault_of([&](Vec3 x) {
              return std::min(ball(x, {}, 0.5), -ball(x, {0.38, 0, 0}, 0.16));
            }),
            GrainFault::not_star_shaped);
}

TEST(CompactGrain, SaysWhatIsWrongWithItsInput) {
  CompactGrain grain;
  EXPECT_THROW(maker().make(std::vector<float>(3), grain), std::invalid_argument);
  EXPECT_THROW(CompactGrainMaker(grains(), 0, 3), std::invalid_argument);
  Library unused = grains();
  unused.net.push_back(unused.net[0]);
  EXPECT_THROW(CompactGrainMaker(unused, 1, 250), std::invalid_argument);
}

}  // namespace
}  // namespace scree
