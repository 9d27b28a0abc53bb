// revolution_test.cpp: walls of revolution: distances against points spread over their surfaces, gradients against
// differences, curvatures against the second derivatives of the distance.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/sdf/analytic.h"

namespace scree {
namespace {

double const pi = 3.141592653589793;

struct Wall {
  char const* name;
  AnalyticSdf shape;
};

AnalyticSdf wall(AnalyticKind kind, Vec3 size, double half_wall = 0) {
  AnalyticSdf s;
  s.kind = kind;
  s.half_size = size;
  s.half_wall = half_wall;
  return s;
}

std::vector<Wall> const walls = {{"cylinder", wall(AnalyticKind::cylinder, {0.4, 0.4, 0.3})},
                                 {"bore", wall(AnalyticKind::bore, {0.5, 0.5, 0.3})},
                                 {"capsule", wall(AnalyticKind::capsule, {0.2, 0.2, 0.4})},
                                 {"funnel", wall(AnalyticKind::funnel, {0.15, 0.6, 0.5}, 0.04)}};

class Revolution : public ::testing::TestWithParam<Wall> {};

Vec3 draw(std::mt19937& random) {
  std::uniform_real_distribution<double> u(-0.9, 0.9);
  return {u(random), u(random), u(random)};
}

// The zero set along rays in the half plane (r, z): where phi changes its sign on a fine grid, to 1e-6.
std::vector<Vec3> meridian(AnalyticSdf const& shape) {
  std::vector<Vec3> points;
  int const n = 1200;
  double const step = 3.0 / n;
  auto const phi = [&](double r, double z) { return signed_distance(shape, {r, 0, z}, nullptr); };
  for (int i = 0; i < n; ++i)
    for (int j = -n; j < n; ++j) {
      double const r = i * step, z = j * step * 0.5, here = phi(r, z);
      for (auto [dr, dz] : {std::pair{step, 0.0}, std::pair{0.0, step * 0.5}}) {
        if (here * phi(r + dr, z + dz) > 0) continue;
        double low = 0, high = 1;
        for (int k = 0; k < 12; ++k) {
          double const middle = (low + high) / 2;
          (here * phi(r + middle * dr, z + middle * dz) > 0 ? low : high) = middle;
        }
        points.push_back({r + low * dr, 0, z + low * dz});
      }
    }
  return points;
}

TEST_P(Revolution, IsTheDistanceToItsOwnZeroSet) {
  AnalyticSdf const& shape = GetParam().shape;
  std::vector<Vec3> const surface = meridian(shape);
  ASSERT_GT(surface.size(), 200u);
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    Vec3 const x = draw(random);
    double const r = std::hypot(x.x, x.y);
    double nearest = 1e300;
    for (Vec3 const& s : surface) nearest = std::min(nearest, std::hypot(s.x - r, s.z - x.z));
    // Points stand 2.5e-3 apart or a little more: the nearest one is up to 2e-3 beside the foot; on the funnel's rims,
    // of radius 0.04, it is 2e-3^2 / (2 x 0.04) further.
    double const phi = std::abs(signed_distance(shape, x, nullptr));
    EXPECT_NEAR(phi, nearest, 5e-5 + std::hypot(phi, 2e-3) - phi) << x.x << " " << x.y << " " << x.z;
  }
}

TEST_P(Revolution, GradientIsTheDerivative) {
  AnalyticSdf const& shape = GetParam().shape;
  std::mt19937 random(4);
  double const h = 1e-6;
  int off = 0;
  for (int i = 0; i < 300; ++i) {
    Vec3 const x = draw(random);
    Vec3 gradient, numeric;
    signed_distance(shape, x, &gradient);
    EXPECT_NEAR(norm(gradient), 1, 1e-12);
    for (int k = 0; k < 3; ++k) {
      Vec3 e;
      e[k] = h;
      numeric[k] = (signed_distance(shape, x + e, nullptr) - signed_distance(shape, x - e, nullptr)) / (2 * h);
    }
    off += norm(gradient - numeric) > 1e-5;  // beside the medial axis the difference straddles it
  }
  EXPECT_LE(off, 2);
}

// A distance field's second derivative along a principal direction at distance t is c / (1 + c t), c the curvature.
TEST_P(Revolution, CurvaturesAreThoseOfTheSurface) {
  AnalyticSdf const& shape = GetParam().shape;
  if (shape.kind == AnalyticKind::cylinder) return;  // not smooth: its curvatures are not asked for
  std::mt19937 random(5);
  double const h = 1e-4;
  int tried = 0;
  for (int i = 0; i < 2000 && tried < 100; ++i) {
    Vec3 const x = draw(random);
    double const phi = signed_distance(shape, x, nullptr);
    if (phi > -0.01 || phi < -0.1) continue;
    double laplacian = 0;
    for (int k = 0; k < 3; ++k) {
      Vec3 e;
      e[k] = h;
      laplacian +=
          (signed_distance(shape, x + e, nullptr) + signed_distance(shape, x - e, nullptr) - 2 * phi) / (h * h);
    }
    Curvatures const c = wall_curvatures(shape, x);
    double const t = -phi;  // outside
    EXPECT_NEAR(-laplacian, c.first / (1 + c.first * t) + c.second / (1 + c.second * t),
                2e-3 * (1 + std::abs(laplacian)))
        << x.x << " " << x.y << " " << x.z;
    ++tried;
  }
  EXPECT_GE(tried, 50);
}

TEST_P(Revolution, SupportIsReachedOnTheSurface) {
  AnalyticSdf const& shape = GetParam().shape;
  std::vector<Vec3> const surface = meridian(shape);
  if (shape.kind == AnalyticKind::bore) {
    EXPECT_GT(support(shape, {1, 0, 0}, nullptr), 1e100);
    return;
  }
  for (int i = 0; i < 100; ++i) {
    double const tilt = pi * (i + 0.5) / 100;
    Vec3 const n{std::sin(tilt), 0, std::cos(tilt)};
    Vec3 reached;
    double const h = support(shape, n, &reached);
    EXPECT_NEAR(signed_distance(shape, reached, nullptr), 0, 1e-12);
    double largest = -1e300;
    for (Vec3 const& s : surface) largest = std::max(largest, dot(n, s));
    EXPECT_NEAR(h, largest, 3e-3);  // the grid's step
    EXPECT_GE(h, largest - 1e-3);
  }
}

INSTANTIATE_TEST_SUITE_P(Walls, Revolution, ::testing::ValuesIn(walls),
                         [](auto const& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace scree
