// test_studies.cpp: the superellipsoid set against its formula, and tables of results.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <set>

#include "shapes/mesh/icosphere.h"
#include "shapes/mesh_report.h"
#include "shapes/random.h"
#include "training/studies/csv_file.h"
#include "training/studies/recipes.h"
#include "training/studies/superellipsoid_set.h"

namespace scree {
namespace {

// |x|^p + |y|^p + |z|^p = 1 with p = 2 / exponent, the set's body before its axes stretch it: the factor that takes a
// direction to its surface.
double radius_of_even_body(Vec3 u, double exponent) {
  double const p = 2 / exponent;
  return std::pow(std::pow(std::abs(u.x), p) + std::pow(std::abs(u.y), p) + std::pow(std::abs(u.z), p), -1 / p);
}

// Integral of r^3 / 3 over the directions of an octant, midpoint rule, times 8. Ridges on the coordinate planes leave
// an error of second order or nearly so: 1e-4 with 400 angles.
double volume_of_even_body(double exponent) {
  int constexpr n = 400;
  double constexpr step = std::numbers::pi / 2 / n;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      double const polar = (i + 0.5) * step, angle = (j + 0.5) * step;
      Vec3 const u{std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar)};
      double const r = radius_of_even_body(u, exponent);
      sum += r * r * r * std::sin(polar);
    }
  return 8 * sum * step * step / 3;
}

TEST(SuperellipsoidSet, HasTheVolumesAndRatiosItClaims) {
  std::vector<SetSuperellipsoid> const set = superellipsoid_set();
  ASSERT_EQ(set.size(), 125u);
  std::set<std::string> names;
  std::map<double, double> even_volume;
  for (double e : superellipsoid_exponents) even_volume[e] = volume_of_even_body(e);
  for (SetSuperellipsoid const& s : set) {
    names.insert(s.shape.name);
    Vec3 const half = s.shape.analytic.half_size;
    EXPECT_NEAR(half.x * half.y * half.z * even_volume[s.exponent], std::numbers::pi / 6, 5e-4) << s.shape.name;
    EXPECT_NEAR(half.y / half.x, s.elongation, 1e-12);
    EXPECT_NEAR(half.z / half.y, s.flatness, 1e-12);
    EXPECT_EQ(s.shape.analytic.exponent_ns, s.exponent);
    EXPECT_EQ(s.shape.analytic.exponent_ew, s.exponent);
  }
  EXPECT_EQ(names.size(), 125u);
}

// The nearest of many points of the surface is never nearer than the true distance, and farther by no more than the
// surface's largest gap between points.
TEST(SuperellipsoidSet, DistancesAreEuclidean) {
  TriangleMesh const sphere = icosphere(5);
  std::map<double, std::vector<Vec3>> even;
  for (double e : superellipsoid_exponents)
    for (Vec3 const& u : sphere.vertex) even[e].push_back(u * radius_of_even_body(u, e));
  Random random(8);
  double excess = 0;
  int count = 0;
  for (SetSuperellipsoid const& s : superellipsoid_set()) {
    Vec3 const half = s.shape.analytic.half_size;
    std::vector<Vec3> surface = even[s.exponent];
    for (Vec3& x : surface)
      for (int k = 0; k < 3; ++k) x[k] *= half[k];
    double gap = 0;
    for (auto const& [a, b, c] : sphere.triangle)
      gap = std::max({gap, norm(surface[a] - surface[b]), norm(surface[b] - surface[c])});
    for (int i = 0; i < 4; ++i) {
      Vec3 x;
      for (int k = 0; k < 3; ++k) x[k] = 1.2 * half[k] * random.uniform(-1, 1);
      double nearest2 = 1e300;
      for (Vec3 const& v : surface) nearest2 = std::min(nearest2, norm2(v - x));
      double const phi = signed_distance(s.shape.analytic, x, nullptr), nearest = std::sqrt(nearest2);
      Vec3 const even_x{x.x / half.x, x.y / half.y, x.z / half.z};
      EXPECT_EQ(phi > 0, norm(even_x) < radius_of_even_body(normalized(even_x), s.exponent)) << s.shape.name;
      // Beside the ridges of exponent 1.8 the kernel's Newton may stop short, see superellipsoid.h.
      EXPECT_LE(std::abs(phi), nearest + (s.exponent > 1.5 ? 3e-3 * half.x : 1e-8)) << s.shape.name;
      EXPECT_GE(std::abs(phi), nearest - gap) << s.shape.name;
      excess += nearest - std::abs(phi);
      ++count;
    }
  }
  // On flat surface a gap s leaves s^2 / (2 phi): with 0.02 d and 0.1 d, 2e-3 d.
  EXPECT_LT(excess / count, 3e-3);
}

TEST(SuperellipsoidSet, MeshesAreClosedAndOnTheSurface) {
  for (double exponent : {0.2, 1.8}) {
    SetSuperellipsoid const s = set_superellipsoid(0.4, 0.4, exponent);
    TriangleMesh const mesh = superellipsoid_mesh(s.shape, 16);
    EXPECT_TRUE(report_mesh(mesh).defects.empty());
    // Chords lie inside a convex body.
    EXPECT_LT(mesh_mass(mesh).volume, s.shape.volume);
    EXPECT_GT(mesh_mass(mesh).volume, 0.97 * s.shape.volume);
    for (std::size_t i = 0; i < mesh.vertex.size(); i += 50)
      EXPECT_NEAR(signed_distance(s.shape.analytic, mesh.vertex[i], nullptr), 0, 1e-4);
  }
}

// The meter: against a field that is off by a known amount.
TEST(FieldErrors, AreThoseOfAShiftedTruth) {
  Body const body = superellipsoid_body(set_superellipsoid(0.7, 0.7, 1));
  double constexpr shift = 3e-3;
  PhiBatch const shifted = [&](Span<const Vec3> point, Span<double> phi, Span<Vec3>) {
    body.distance->evaluate(point, phi, {}, 1);
    for (int i = 0; i < phi.size(); ++i) phi[i] += shift;
  };
  FieldErrors const e = field_errors(shifted, body, 500, 1);
  for (double value : {e.mae, e.p99, e.max, e.band_mae}) EXPECT_NEAR(value, shift, 1e-12);
}

TEST(CsvFile, WritesRowsAndQuotes) {
  namespace fs = std::filesystem;
  fs::path const file = fs::temp_directory_path() / ("scree_csv_" + std::to_string(::getpid()) + ".csv");
  {
    CsvFile csv(file, {"name", "value"});
    csv.row("a, \"b\"", 0.5);
    csv.row("c", 3);
    EXPECT_THROW(csv.row("short"), std::logic_error);
  }
  std::ifstream in(file);
  std::string const text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(text, "name,value\n\"a, \"\"b\"\"\",0.5\nc,3\n");
  fs::remove(file);
  EXPECT_THROW(CsvFile(file / "nowhere.csv", {"a"}), std::system_error);
}

}  // namespace
}  // namespace scree
