// test_descriptors.cpp: descriptors of bodies whose values are known.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "shapes/analytic_shapes.h"
#include "shapes/descriptors.h"
#include "shapes/support_points.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

TriangleMesh mesh_of(char const* spec) {
  Library const library;
  Shape const shape = builtin_shape(spec);
  PhiBatch const phi = surface_phi(library, shape);
  ZeroSet set = refine(phi, find_zero_set(phi, {1.05 * shape.bounding_radius, 40, 1}));
  sharpen_corners(phi, set);
  return set.mesh;
}

TEST(Descriptors, SphereAndEllipsoid) {
  Descriptors const sphere = describe(mesh_of("sphere"));
  EXPECT_NEAR(sphere.sphericity, 1, 1e-3);  // inscribed triangles
  EXPECT_NEAR(sphere.convexity, 1, 2e-3);
  EXPECT_NEAR(sphere.elongation, 1, 1e-3);
  EXPECT_NEAR(sphere.flatness, 1, 1e-3);
  Descriptors const egg = describe(mesh_of("ellipsoid:1:0.8:0.4"));
  EXPECT_NEAR(egg.elongation, 0.8, 2e-3);
  EXPECT_NEAR(egg.flatness, 0.5, 2e-3);
  EXPECT_NEAR(egg.convexity, 1, 2e-3);
}

TEST(Descriptors, CubeHasItsSphericity) {
  Descriptors const cube = describe(mesh_of("box:1:1:1"));
  EXPECT_NEAR(cube.sphericity, std::cbrt(std::numbers::pi / 6), 2e-3);
  EXPECT_NEAR(cube.convexity, 1, 2e-3);
}

TEST(Descriptors, TwoBallsAreNotConvex) {
  // Balls of radius r at distance 2 L = 4 r: hull = both halves and a cylinder between, 4/3 pi r^3 + pi r^2 4 r.
  double constexpr r = 0.2;
  PhiBatch const phi = [](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    for (int i = 0; i < x.size(); ++i) {
      Vec3 const p = x[i] - Vec3{x[i].x < 0 ? -2 * r : 2 * r, 0, 0};
      value[i] = r - norm(p);
      if (!gradient.empty()) gradient[i] = p / -std::max(norm(p), 1e-9);
    }
  };
  Descriptors const d = describe(refine(phi, find_zero_set(phi, {0.65, 48, 1})).mesh);
  EXPECT_NEAR(d.convexity, (8.0 / 3) / (4.0 / 3 + 4), 5e-3);
  EXPECT_NEAR(d.elongation, 1.0 / 3, 2e-3);
  EXPECT_THROW(describe(TriangleMesh{}), std::invalid_argument);
}

}  // namespace
}  // namespace scree
