// test_surface_samples.cpp: points even over a mesh or over phi = 0, star-shaped radii, and fits by spherical
// harmonics.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/sdf/harmonics.h"
#include "shapes/analytic_shapes.h"
#include "shapes/harmonics_fit.h"
#include "shapes/mesh_samples.h"
#include "shapes/star_radii.h"
#include "shapes/support_points.h"
#include "shapes/surface_samples.h"

namespace scree {
namespace {

// Two unit squares in the planes z = 0 and z = 3, the upper one cut in 2 * n^2 triangles: evenness must not follow
// them.
TriangleMesh squares(int n) {
  TriangleMesh mesh;
  mesh.vertex = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangle = {{0, 2, 1}, {0, 3, 2}};
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) mesh.vertex.push_back({double(i) / n, double(j) / n, 3});
  auto const at = [&](int i, int j) { return 4 + i * (n + 1) + j; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangle.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangle.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(MeshSamples, AreEvenOverTheAreaWithTheTrianglesNormals) {
  int const count = 2000;
  PointCloud const cloud = sample_mesh(squares(20), count);
  ASSERT_EQ(cloud.position.size(), 2000u);
  int lower = 0, quarter = 0;
  for (int i = 0; i < count; ++i) {
    bool const low = cloud.position[i].z == 0;
    lower += low;
    quarter += cloud.position[i].x < 0.5 && cloud.position[i].y < 0.5;
    EXPECT_TRUE(cloud.normal[i] == (Vec3{0, 0, low ? -1.0 : 1.0}));
  }
  // Thrown independently these would spread by sqrt(n p q) = 22 and 19; darts repel each other.
  EXPECT_NEAR(lower, count / 2, 30);
  EXPECT_NEAR(quarter, count / 4, 30);
  double least = 1;
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j) least = std::min(least, norm(cloud.position[i] - cloud.position[j]));
  EXPECT_GT(least, 0.6 * std::sqrt(2 * 2 / (std::sqrt(3.0) * count)));
  PointCloud const again = sample_mesh(squares(20), count);
  for (int i = 0; i < count; ++i) EXPECT_TRUE(again.position[i] == cloud.position[i]);
  EXPECT_THROW(sample_mesh(squares(1), 0), std::invalid_argument);
  EXPECT_THROW(sample_mesh({}, 10), std::invalid_argument);
}

TEST(StarRadii, AreClosedFormOrNothing) {
  Library const library;
  Shape const body = make_ellipsoid({1, 0.7, 0.4});
  std::vector<Vec3> const direction = quasi_uniform_directions(300);
  std::vector<double> const r = star_radii(reference_phi(library, body), direction, 1.1 * body.bounding_radius);
  ASSERT_EQ(r.size(), 300u);
  for (int i = 0; i < 300; ++i)
    EXPECT_NEAR(r[i], 1 / norm(divide(direction[i], body.analytic.half_size)), 1e-7 * body.bounding_radius);
  PhiBatch const shell = [](Span<const Vec3> x, Span<double> phi, Span<Vec3>) {  // a hollow ball
    for (int i = 0; i < x.size(); ++i) phi[i] = 0.1 - std::abs(norm(x[i]) - 0.4);
  };
  EXPECT_TRUE(star_radii(shell, direction, 1).empty());
}

TEST(SurfaceSamples, LieOnTheSurfaceWithItsNormals) {
  Library const library;
  Shape const body = make_ellipsoid({1, 0.7, 0.4});
  Vec3 const a = body.analytic.half_size;
  PhiBatch const phi = reference_phi(library, body);
  ZeroSetOptions const domain{.radius = 1.1 * body.bounding_radius, .cells = 16, .lipschitz = 1};
  for (SampleSpread spread : {SampleSpread::area, SampleSpread::directions}) {
    SurfaceSamples const s = sample_surface(phi, domain, 500, spread);
    EXPECT_EQ(s.projection.failures(), 0);
    ASSERT_EQ(s.cloud.position.size(), 500u);
    Vec3 sum;
    for (int i = 0; i < 500; ++i) {
      Vec3 const x = s.cloud.position[i];
      EXPECT_NEAR(norm(divide(x, a)), 1, 1e-6 / a.z);  // the tolerance on phi over the shortest semi-axis
      EXPECT_NEAR(norm(s.cloud.normal[i] - normalized(divide(divide(x, a), a))), 0, 1e-4);
      sum += x / 500;
    }
    EXPECT_NEAR(norm(sum), 0, 0.02);
    if (spread == SampleSpread::directions) {
      std::vector<Vec3> const n = quasi_uniform_directions(500);
      for (int i = 0; i < 500; ++i) EXPECT_NEAR(norm(cross(s.cloud.position[i], n[i])), 0, 1e-12);
    }
  }
}

TEST(HarmonicsFit, ReturnsTheCoefficientsItsPointsWereMadeOf) {
  int const degree = 5;
  std::vector<double> c(harmonic_count(degree), 0);
  c[0] = 2 * std::sqrt(std::numbers::pi);  // mean radius 1
  for (std::size_t k = 1; k < c.size(); ++k) c[k] = 0.05 * std::sin(7.0 * static_cast<double>(k));
  std::vector<Vec3> point = quasi_uniform_directions(400);
  for (Vec3& x : point) x *= harmonic_radius(c, x, nullptr);
  HarmonicsFit const same = fit_harmonics(point, degree);
  ASSERT_EQ(same.coefficient.size(), c.size());
  for (std::size_t k = 0; k < c.size(); ++k) EXPECT_NEAR(same.coefficient[k], c[k], 1e-12);  // rounding
  EXPECT_LT(same.largest, 1e-12);
  HarmonicsFit const more = fit_harmonics(point, degree + 3);
  for (std::size_t k = 0; k < more.coefficient.size(); ++k)
    EXPECT_NEAR(more.coefficient[k], k < c.size() ? c[k] : 0, 1e-11);
  // Too low a degree: what it lacks is its residual, as the basis is orthonormal over the sphere.
  double lacking = 0;
  for (int k = harmonic_count(degree - 1); k < harmonic_count(degree); ++k)
    lacking += c[k] * c[k] / (4 * std::numbers::pi);
  HarmonicsFit const less = fit_harmonics(point, degree - 1);
  EXPECT_NEAR(less.rms, std::sqrt(lacking), 0.02 * less.rms);
  EXPECT_GT(less.largest, less.rms);
}

TEST(HarmonicsFit, RefusesWhatLeavesItOpen) {
  std::vector<Vec3> const all = quasi_uniform_directions(400);
  EXPECT_THROW(fit_harmonics(all, -1), std::invalid_argument);
  EXPECT_THROW(fit_harmonics(all, 21), std::invalid_argument);
  EXPECT_THROW(fit_harmonics(all, 20), std::invalid_argument);  // 441 coefficients
  std::vector<Vec3> ring;
  for (int i = 0; i < 100; ++i) ring.push_back({std::cos(0.1 * i), std::sin(0.1 * i), 0});
  EXPECT_THROW(fit_harmonics(ring, 2), std::invalid_argument);
  std::vector<Vec3> centre = all;
  centre[7] = {};
  EXPECT_THROW(fit_harmonics(centre, 2), std::invalid_argument);
}

}  // namespace
}  // namespace scree
