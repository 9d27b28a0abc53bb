// analytic_test.cpp: true distances against the support function, which gives phi of a convex body independently.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/analytic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace scree {
namespace {

// phi(x) = min over unit n of h(n) - n.x for a convex body: pattern search from the best of many directions. An upper
// bound of the true minimum, so phi may lie below it by the search's own error but never above.
double phi_by_support(AnalyticSdf const& shape, Vec3 x, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  auto const draw = [&] { return Vec3{u(random), u(random), u(random)}; };
  auto const value = [&](Vec3 n) { return support(shape, n, nullptr) - dot(n, x); };
  Vec3 best{0, 0, 1};
  for (int i = 0; i < 500; ++i) {
    Vec3 const n = normalized(draw());
    if (value(n) < value(best)) best = n;
  }
  for (double step = 0.1; step > 1e-9;) {
    bool better = false;
    for (int i = 0; i < 12; ++i) {
      Vec3 const n = normalized(best + draw() * step);
      if (value(n) < value(best)) best = n, better = true;
    }
    if (!better) step *= 0.6;
  }
  return value(best);
}

struct Named {
  char const* name;
  AnalyticSdf shape;
  double tolerance;  // of the support search: it stalls in the creases that flat faces and ridges cut into h
};

class Analytic : public ::testing::TestWithParam<Named> {};

TEST_P(Analytic, EqualsTheSupportFunctionsDistance) {
  AnalyticSdf const& shape = GetParam().shape;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 150; ++i) {
    Vec3 const x{u(random), u(random), u(random)};
    double const phi = signed_distance(shape, x, nullptr);
    double const other = phi_by_support(shape, x, random);
    EXPECT_LT(phi, other + 1e-8) << x.x << " " << x.y << " " << x.z;
    EXPECT_GT(phi, other - GetParam().tolerance) << x.x << " " << x.y << " " << x.z;
  }
}

TEST_P(Analytic, GradientIsTheDerivativeAndHasLengthOne) {
  AnalyticSdf const& shape = GetParam().shape;
  std::mt19937 random(8);
  std::uniform_real_distribution<double> u(-1, 1);
  double const h = 1e-6;
  int off = 0;
  for (int i = 0; i < 300; ++i) {
    Vec3 const x{u(random), u(random), u(random)};
    Vec3 gradient, difference;
    signed_distance(shape, x, &gradient);
    EXPECT_NEAR(norm(gradient), 1, 1e-9);
    for (int k = 0; k < 3; ++k) {
      Vec3 plus = x, minus = x;
      plus[k] += h, minus[k] -= h;
      difference[k] = (signed_distance(shape, plus, nullptr) - signed_distance(shape, minus, nullptr)) / (2 * h);
    }
    // Near the ridges of exponent 1.8 the header promises no more than 1e-2.
    off += norm(gradient - difference) > (shape.exponent_ns > 1.5 ? 1e-2 : 1e-4);
  }
  // The medial axis has no derivative; few random points come within h of it.
  EXPECT_LE(off, 2);
}

TEST_P(Analytic, IsZeroAtSupportPoints) {
  AnalyticSdf const& shape = GetParam().shape;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 100; ++i) {
    Vec3 point;
    support(shape, normalized(Vec3{u(random), u(random), u(random)}), &point);
    EXPECT_NEAR(signed_distance(shape, point, nullptr), 0, 1e-8);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Analytic,
    ::testing::Values(Named{"sphere", {AnalyticKind::sphere, {0.5, 0.5, 0.5}}, 1e-8},
                      Named{"ellipsoid", {AnalyticKind::ellipsoid, {0.6, 0.4, 0.3}}, 1e-8},
                      Named{"flat_ellipsoid", {AnalyticKind::ellipsoid, {0.9, 0.9, 0.05}}, 1e-8},
                      Named{"box", {AnalyticKind::box, {0.5, 0.3, 0.4}}, 5e-2},
                      Named{"superellipsoid_0_6", {AnalyticKind::superellipsoid, {0.6, 0.4, 0.3}, 0.6, 0.6}, 1e-4},
                      Named{"superellipsoid_1", {AnalyticKind::superellipsoid, {0.6, 0.4, 0.3}, 1, 1}, 1e-8},
                      Named{"superellipsoid_1_4", {AnalyticKind::superellipsoid, {0.6, 0.4, 0.3}, 1.4, 1.4}, 1e-4},
                      Named{"superellipsoid_0_2", {AnalyticKind::superellipsoid, {0.6, 0.4, 0.3}, 0.2, 0.2}, 5e-2},
                      Named{"superellipsoid_1_8", {AnalyticKind::superellipsoid, {0.6, 0.4, 0.3}, 1.8, 1.8}, 1e-4}),
    [](auto const& info) { return info.param.name; });

// Outside a convex body n . x - h(n) is a lower bound of the distance for every unit n, and equals it for n along the
// line to the nearest point alone: what the distance exceeds the bound at its own gradient by is its error. 1e-11 of
// |x|: rounding of far points and of exponent 0.1, where coordinates are raised to the power of 20.
TEST(Superellipsoid, DistancesOutsideMeetTheirLowerBound) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  Vec3 const slender{1, 0.16, 0.06}, plate{0.1, 0.7, 0.9}, needle{0.06, 0.06, 1}, block{0.6, 0.4, 0.3};
  double constexpr exponents[] = {0.1, 0.4, 1, 1.4, 1.8, 1.9};
  int outside = 0;
  for (Vec3 const& half_size : {slender, plate, needle, block})
    for (double ns : exponents)
      for (double ew : exponents) {
        AnalyticSdf const shape{AnalyticKind::superellipsoid, half_size, ns, ew};
        for (double reach : {1.05, 1e4})
          for (int i = 0; i < 30; ++i) {
            Vec3 x{u(random) * reach, u(random) * reach, u(random) * reach};
            if (i % 5 == 0) x[i / 5 % 3] = 0;  // the planes in which ridges lie
            Vec3 gradient;
            double const distance = -signed_distance(shape, x, &gradient);
            if (distance <= 0) continue;
            ++outside;
            double const bound = dot(-gradient, x) - support(shape, -gradient, nullptr);
            EXPECT_NEAR(distance, bound, 1e-11 * std::max(1.0, norm(x)))
                << "semi-axes " << half_size.x << " " << half_size.y << " " << half_size.z << ", exponents " << ns
                << " " << ew << ", at " << x.x << " " << x.y << " " << x.z;
          }
      }
  EXPECT_GT(outside, 7000);
}

// On the way out of a tip and of a ridge phi falls by exactly the way: the foot stays where it is.
TEST(Superellipsoid, RidgesAndTipsKeepTheirFoot) {
  AnalyticSdf const shape{AnalyticKind::superellipsoid, {1, 0.3, 0.2}, 1.8, 1.8};
  for (double way : {1e-9, 1e-4, 0.1, 10.0}) {
    EXPECT_NEAR(signed_distance(shape, {1 + way, 0, 0}, nullptr), -way, 1e-11 * (1 + way));
    EXPECT_NEAR(signed_distance(shape, {0, 0, -0.2 - way}, nullptr), -way, 1e-11 * (1 + way));
  }
}

TEST(Analytic, SphereAndEllipsoidOfEqualAxesAgree) {
  AnalyticSdf const sphere{AnalyticKind::sphere, {0.4, 0.4, 0.4}}, ellipsoid{AnalyticKind::ellipsoid, {0.4, 0.4, 0.4}};
  for (Vec3 x : {Vec3{0.1, 0.2, -0.3}, Vec3{1, -2, 3}, Vec3{0, 0, 0.2}, Vec3{0, 0, 0}})
    EXPECT_NEAR(signed_distance(sphere, x, nullptr), signed_distance(ellipsoid, x, nullptr), 1e-12);
}

}  // namespace
}  // namespace scree
