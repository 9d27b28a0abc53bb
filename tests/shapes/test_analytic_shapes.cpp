// test_analytic_shapes.cpp: grains given by a formula are normalised, and words name them.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/analytic_shapes.h"

namespace scree {
namespace {

double constexpr pi = std::numbers::pi;

// Volume, area and second moments of a superellipsoid by midpoint quadrature over the gauge's unit directions: an
// independent path to what the Beta functions give. r(u) = 1 / gauge(u) is the radius along the unit vector u.
struct Moments {
  double volume = 0, xx = 0, yy = 0, zz = 0, longest = 0;
};
Moments by_quadrature(AnalyticSdf const& s) {
  Moments m;
  int constexpr n = 600;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double const z = (i + 0.5) / n, angle = pi / 2 * (j + 0.5) / n, h = std::sqrt(1 - z * z);
      Vec3 const u{h * std::cos(angle), h * std::sin(angle), z};
      Vec3 const v = divide(u, s.half_size);
      double const p = 2 / s.exponent_ew, q = 2 / s.exponent_ns;
      double const r = std::pow(std::pow(std::pow(v.x, p) + std::pow(v.y, p), q / p) + std::pow(v.z, q), -1 / q);
      double const weight = 8 * pi / 2 / (double(n) * n), r5 = std::pow(r, 5) / 5;
      m.volume += weight * r * r * r / 3;
      m.xx += weight * r5 * u.x * u.x;
      m.yy += weight * r5 * u.y * u.y;
      m.zz += weight * r5 * u.z * u.z;
      m.longest = std::max(m.longest, r);
    }
  return m;
}

TEST(AnalyticShapes, SphereIsTheUnit) {
  Shape const s = make_sphere();
  EXPECT_DOUBLE_EQ(s.volume, pi / 6);
  EXPECT_DOUBLE_EQ(s.area, pi);
  EXPECT_DOUBLE_EQ(s.inertia.x, 0.4 * pi / 6 * 0.25);
  EXPECT_DOUBLE_EQ(s.bounding_radius, 0.5);
}

TEST(AnalyticShapes, EllipsoidHasItsClosedForms) {
  Shape const s = make_ellipsoid({2, 1, 1});
  Vec3 const a = s.analytic.half_size;
  EXPECT_NEAR(4 * pi / 3 * a.x * a.y * a.z, pi / 6, 1e-15);
  EXPECT_NEAR(a.x / a.y, 2, 1e-15);
  EXPECT_NEAR(s.inertia.x, pi / 30 * (a.y * a.y + a.z * a.z), 1e-14);
  EXPECT_NEAR(s.inertia.z, pi / 30 * (a.x * a.x + a.y * a.y), 1e-14);
  double const e = std::sqrt(1 - a.y * a.y / (a.x * a.x));  // prolate spheroid
  EXPECT_NEAR(s.area, 2 * pi * a.y * a.y * (1 + a.x / (a.y * e) * std::asin(e)), 1e-4 * s.area);
  EXPECT_DOUBLE_EQ(s.bounding_radius, a.x);
}

TEST(AnalyticShapes, SuperellipsoidMatchesQuadrature) {
  struct Case {
    Vec3 axes;
    double ns, ew;
  };
  for (Case const& c : {Case{{1, 1, 1}, 1, 1}, Case{{1, 0.8, 0.6}, 0.5, 0.5}, Case{{1, 0.7, 0.5}, 0.3, 1.4},
                        Case{{1, 0.9, 0.4}, 1.6, 0.6}}) {
    Shape const s = make_superellipsoid(c.axes, c.ns, c.ew);
    Moments const m = by_quadrature(s.analytic);
    // The radius has kinks where the body has edges: midpoint rule, 600^2 directions, error below 1e-4.
    EXPECT_NEAR(m.volume, pi / 6, 1e-4);
    EXPECT_NEAR(s.inertia.x, m.yy + m.zz, 1e-4 * s.inertia.x);
    EXPECT_NEAR(s.inertia.y, m.xx + m.zz, 1e-4 * s.inertia.y);
    EXPECT_NEAR(s.inertia.z, m.xx + m.yy, 1e-4 * s.inertia.z);
    EXPECT_GE(s.bounding_radius, m.longest * (1 - 1e-14));
    EXPECT_LE(s.bounding_radius, m.longest * 1.01);  // directions 0.15 degrees apart come close to the tip
  }
  EXPECT_NEAR(make_superellipsoid({1, 1, 1}, 1, 1).area, pi, 1e-4);
  // Exponent 0.1 is a cube but for rounded edges: |x|^20 + |y|^20 + |z|^20 = 1.
  Shape const cube = make_superellipsoid({1, 1, 1}, 0.1, 0.1);
  EXPECT_NEAR(cube.area, 24 * cube.analytic.half_size.x * cube.analytic.half_size.x, 0.06 * cube.area);
}

TEST(AnalyticShapes, BoxHasItsClosedForms) {
  Shape const s = make_box({1, 0.5, 0.25});
  Vec3 const h = s.analytic.half_size;
  EXPECT_NEAR(8 * h.x * h.y * h.z, pi / 6, 1e-15);
  EXPECT_NEAR(s.inertia.z, pi / 6 * (4 * h.x * h.x + 4 * h.y * h.y) / 12, 1e-14);
  EXPECT_NEAR(s.area, 2 * (4 * h.x * h.y + 4 * h.y * h.z + 4 * h.z * h.x), 1e-14);
  EXPECT_DOUBLE_EQ(s.bounding_radius, norm(h));
}

TEST(AnalyticShapes, WordsNameShapes) {
  EXPECT_EQ(builtin_shape("sphere").analytic.kind, AnalyticKind::sphere);
  Shape const s = builtin_shape("superellipsoid:1:0.8:0.6:0.5");
  EXPECT_EQ(s.name, "superellipsoid:1:0.8:0.6:0.5");
  EXPECT_EQ(s.analytic.exponent_ns, 0.5);
  EXPECT_EQ(s.analytic.exponent_ew, 0.5);
  EXPECT_EQ(builtin_shape("superellipsoid:1:1:1:0.5:1.2").analytic.exponent_ew, 1.2);
  EXPECT_EQ(builtin_shape("box:2:1:1").analytic.half_size.x, make_box({2, 1, 1}).analytic.half_size.x);
  EXPECT_FALSE(is_builtin_shape("grains:ballast/0"));
  for (char const* bad :
       {"cube", "sphere:1", "ellipsoid", "ellipsoid:1:2", "ellipsoid:1:2:x", "ellipsoid:1:2:", "box:1:1:0",
        "box:1:1:-1", "box:1:1:nan", "superellipsoid:1:1:1:2.5", "superellipsoid:1:1:1", "box:1:1:1000", ""}) {
    try {
      builtin_shape(bad);
      ADD_FAILURE() << bad;
    } catch (std::invalid_argument const& e) {
      EXPECT_NE(std::string(e.what()).find("superellipsoid:1:0.8:0.6:0.5"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace scree
