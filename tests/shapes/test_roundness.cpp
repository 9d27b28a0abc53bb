// test_roundness.cpp: roundness and inscribed ball of bodies whose values are known.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shapes/analytic_shapes.h"
#include "shapes/roundness.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

// A box of half sizes a with all edges rounded by r: distance to the inner box, less r.
PhiBatch rounded_box(Vec3 a, double r) {
  return [=](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    for (int i = 0; i < x.size(); ++i) {
      Vec3 q, out;
      double inside = -1e300;
      int axis = 0;
      for (int k = 0; k < 3; ++k) {
        q[k] = std::abs(x[i][k]) - (a[k] - r);
        out[k] = std::max(q[k], 0.0);
        if (q[k] > inside) inside = q[k], axis = k;
      }
      double const far = norm(out);
      value[i] = r - far - std::min(inside, 0.0);
      if (gradient.empty()) continue;
      gradient[i] = {};
      if (far > 0) gradient[i] = out / -far;
      if (!(far > 0)) gradient[i][axis] = -1;
      for (int k = 0; k < 3; ++k)
        if (x[i][k] < 0) gradient[i][k] = -gradient[i][k];
    }
  };
}

ZeroSet mesh_of(char const* spec) {
  Library const library;
  Shape const shape = builtin_shape(spec);
  return find_zero_set(surface_phi(library, shape), {1.05 * shape.bounding_radius, 48, 1});
}

TEST(Roundness, SphereIsOne) {
  ZeroSet const sphere = mesh_of("sphere");
  EXPECT_NEAR(roundness(sphere.mesh, sphere.normal), 1, 0.02);
  EXPECT_NEAR(inscribed_radius(sphere.mesh, sphere.normal), 0.5, 1e-3);
}

TEST(Roundness, RoundedBoxesHaveTheirEdgeRadius) {
  Vec3 const a{0.5, 0.45, 0.4};
  for (double const r : {0.1, 0.2, 0.3}) {
    ZeroSet const box = find_zero_set(rounded_box(a, r), {0.85, 96, 1});
    // Triangles across the seam between face and edge count as softer edge: a cell over a quarter circle.
    EXPECT_NEAR(roundness(box.mesh, box.normal), r / a.z, box.cell / a.z) << r;
    EXPECT_NEAR(inscribed_radius(box.mesh, box.normal), a.z, 2e-3);
  }
}

TEST(Roundness, EllipsoidByItsCurvature) {
  // A prolate spheroid 2 : 1 : 1 of semi-axes a = 2 b: the ball has radius b. Along the meridian k = a b / w^3, around
  // the axis 1 / (b w / a ...): the corners are where the larger exceeds 1 / b. Integrated below over the meridian.
  double const b = 1, a = 2;
  double area = 0, turning = 0;
  int constexpr n = 20000;
  for (int i = 0; i < n; ++i) {
    double const t = std::numbers::pi * (i + 0.5) / n, w = std::hypot(a * std::sin(t), b * std::cos(t));
    double const meridian = a * b / (w * w * w), around = a / (b * w);
    double const k = std::max(meridian, around), ring = b * std::sin(t) * w;
    if (k * b <= 1) continue;
    area += ring, turning += ring * k;
  }
  ZeroSet const egg = mesh_of("ellipsoid:2:1:1");
  EXPECT_NEAR(roundness(egg.mesh, egg.normal), area / (turning * b), 0.02);
}

TEST(Roundness, SharpEdgesAreNotRound) {
  ZeroSet const cube = mesh_of("box:1:1:1");
  EXPECT_LT(roundness(cube.mesh, cube.normal), 0.15);
}

}  // namespace
}  // namespace scree
