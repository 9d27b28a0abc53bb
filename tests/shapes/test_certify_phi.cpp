// test_certify_phi.cpp: figures of known bodies, and bodies with known faults.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shapes/analytic_shapes.h"
#include "shapes/certify_phi.h"
#include "shapes/solid_check.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

TEST(CertifyPhi, PercentileIsLinearInRank) {
  EXPECT_EQ(percentile({3, 1, 2}, 0), 1);
  EXPECT_EQ(percentile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(percentile({3, 1, 2}, 0.75), 2.5);
  EXPECT_EQ(percentile({3, 1, 2}, 1), 3);
  EXPECT_EQ(percentile({7}, 0.3), 7);
  EXPECT_EQ(percentile({}, 0.5), -1);
}

TEST(CertifyPhi, SurfacePointsAreUniformInArea) {
  // A right triangle of legs 1 at z = 0 and one of legs 2 at z = 1, which has four times the area.
  TriangleMesh const mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 2, 1}, {2, 0, 1}}, {{0, 1, 2}, {3, 4, 5}}};
  int constexpr n = 4000;
  SurfacePoints const points = surface_points(mesh, n);
  ASSERT_EQ(points.position.size(), std::size_t(n));
  int small = 0;
  Vec3 mean;
  for (int i = 0; i < n; ++i) {
    Vec3 const p = points.position[i];
    bool const first = p.z < 0.5;
    EXPECT_EQ(points.normal[i].z, first ? 1 : -1);
    if (first) {
      ++small;
      continue;
    }
    EXPECT_LE(p.x + p.y, 2 + 1e-12);
    mean += p / (0.8 * n);
  }
  // Low discrepancy: better than the 1 / sqrt(n) of random points.
  EXPECT_NEAR(small, 0.2 * n, 0.01 * n);
  EXPECT_NEAR(mean.x, 2.0 / 3, 0.01);
  EXPECT_NEAR(mean.y, 2.0 / 3, 0.01);
  EXPECT_TRUE(surface_points({}, 10).position.empty());
}

TEST(CertifyPhi, ASphereIsFlawless) {
  Library library;
  library.shape.push_back(builtin_shape("sphere"));
  Certificate c;
  certify_phi(library, library.shape[0], {2000, 250, 1}, c);
  EXPECT_NEAR(c.gradient_p1, 1, 1e-12);
  EXPECT_NEAR(c.gradient_p99, 1, 1e-12);
  EXPECT_EQ(c.falling, 0);
  EXPECT_EQ(c.components, 1);
  EXPECT_EQ(c.euler, 2);
  EXPECT_NEAR(c.gap_nodes, 250, 10);  // about as many as asked for
  // 250 nodes: cells of 4 pi R^2 / 250; the farthest corner of a hexagon of that area lies at s = 0.62 sqrt(area)
  // = 0.069 d, where the sphere is s^2 / (2 R) = 0.0048 d below its top. Nodes are not perfect hexagons.
  EXPECT_GT(c.gap, 0.002);
  EXPECT_LT(c.gap, 0.01);
  EXPECT_EQ(c.mae, -1);  // no truth was asked
  Certificate without_nodes;
  certify_phi(library, library.shape[0], {500, 0, 1}, without_nodes);
  EXPECT_EQ(without_nodes.gap, -1);
}

TEST(CertifyPhi, FallingIsTheShareOfADent) {
  // A ball of radius 1/2 in which phi falls again inside of radius 1/4.
  PhiBatch const dented = [](Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient) {
    for (int i = 0; i < point.size(); ++i) {
      double const r = norm(point[i]);
      phi[i] = r > 0.25 ? 0.5 - r : r;
      if (!gradient.empty()) gradient[i] = point[i] * ((r > 0.25 ? -1 : 1) / std::max(r, 1e-12));
    }
  };
  ZeroSetOptions options;
  options.radius = 0.55;
  options.cells = 32;
  ZeroSet const set = find_zero_set(dented, options);
  // Of the points deeper than 0.05. The nearest vertex may be a cell / sqrt 3 = 0.02 aside of the nearest point, which
  // makes up to 0.004 of depth at 0.05: 3 * 0.004 / 0.45 of the share.
  double const share = std::pow(0.25 / 0.45, 3);
  EXPECT_NEAR(check_solid(dented, set, 0.5, 20000).falling, share, 0.04 * share);
  EXPECT_EQ(check_solid(dented, set, 0.5, 20000).falling, check_solid(dented, set, 0.5, 20000).falling);
}

}  // namespace
}  // namespace scree
