// test_latent.cpp: the Gaussian over codes against its definition.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "shapes/latent.h"

namespace scree {
namespace {

double constexpr infinity = std::numeric_limits<double>::infinity();

Shape coded(std::string const& name, std::vector<float> code, int net = 0) {
  Shape s;
  s.name = name;
  s.kind = ShapeKind::net;
  s.net = net;
  s.code = std::move(code);
  return s;
}

Library four_codes() {
  Library library;
  library.shape = {coded("sand/0", {1, 0, 0, 2, 5}), coded("sand/1", {0, 2, 0, 2, 5}), coded("sand/2", {0, 0, 4, 2, 5}),
                   coded("sand/3", {1, 2, 4, 2, 5}), coded("rock/0", {0, 0, 0, 0, 1})};
  return library;
}

double covariance(std::vector<std::vector<float>> const& code, int i, int j) {
  double mean_i = 0, mean_j = 0, sum = 0;
  auto const n = static_cast<double>(code.size());
  for (auto const& c : code) mean_i += c[i] / n, mean_j += c[j] / n;
  for (auto const& c : code) sum += (c[i] - mean_i) * (c[j] - mean_j);
  return sum / (n - 1);
}

TEST(Latent, AxesMakeTheSampleCovariance) {
  CodeGaussian const g = fit_codes(four_codes(), "sand");
  ASSERT_EQ(g.axis.size(), 3u);  // four points span three directions
  EXPECT_EQ(g.samples, 4);
  std::vector<std::vector<float>> code;
  for (int i = 0; i < 4; ++i) code.push_back(four_codes().shape[i].code);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) {
      double made = 0;
      for (auto const& axis : g.axis) made += axis[i] * axis[j];
      EXPECT_NEAR(made, covariance(code, i, j), 1e-12) << i << j;
    }
}

TEST(Latent, DrawsHaveTheCovarianceAndStayInTheFlat) {
  CodeGaussian const g = fit_codes(four_codes(), "sand");
  Random random(3);
  int constexpr n = 4000;
  std::vector<std::vector<float>> code, known;
  for (int i = 0; i < n; ++i) code.push_back(draw_code(g, infinity, random));
  for (int i = 0; i < 4; ++i) known.push_back(four_codes().shape[i].code);
  for (auto const& c : code) EXPECT_TRUE(c[3] == 2 && c[4] == 5) << "off the flat through the known codes";
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)  // standard error of a covariance: sqrt((C_ii C_jj + C_ij^2) / n); five of them
      EXPECT_NEAR(covariance(code, i, j), covariance(known, i, j),
                  5 * std::sqrt(2 * covariance(known, i, i) * covariance(known, j, j) / n));
}

TEST(Latent, TruncationCutsTheWhitenedCoordinates) {
  CodeGaussian const g = fit_codes(four_codes(), "sand");
  for (double const k : {2.0, 0.5}) {  // both ways of drawing
    Random random(7);
    double sum = 0;
    int constexpr n = 4000;
    for (int i = 0; i < n; ++i)
      for (double xi : whitened(g, draw_code(g, k, random))) {
        ASSERT_LE(std::abs(xi), k + 1e-6);  // codes are floats
        sum += xi * xi / (3 * n);
      }
    // Variance of the cut normal: 1 - 2 k pdf(k) / (2 cdf(k) - 1).
    double const pdf = std::exp(-0.5 * k * k) / std::sqrt(2 * std::numbers::pi);
    double const expected = 1 - 2 * k * pdf / std::erf(k / std::numbers::sqrt2);
    EXPECT_NEAR(sum, expected, 5 * expected * std::sqrt(2.0 / (3 * n))) << k;
  }
}

TEST(Latent, SeedDecides) {
  CodeGaussian const g = fit_codes(four_codes(), "sand");
  Random a(1), b(1), c(2);
  EXPECT_EQ(draw_code(g, 2, a), draw_code(g, 2, b));
  EXPECT_NE(draw_code(g, 2, a), draw_code(g, 2, c));
}

TEST(Latent, ShrinkageLeavesTheFlatAndKeepsTheTrace) {
  CodeGaussian const g = fit_codes(four_codes(), "sand"), s = fit_codes(four_codes(), "sand", 0.3);
  EXPECT_EQ(s.axis.size(), 5u);
  double before = 0, after = 0;
  for (auto const& axis : g.axis)
    for (double v : axis) before += v * v;
  for (auto const& axis : s.axis)
    for (double v : axis) after += v * v;
  EXPECT_NEAR(after, before, 1e-12 * before);
  double least = 0;
  for (double v : s.axis.back()) least += v * v;
  EXPECT_NEAR(least, 0.3 * before / 5, 1e-12 * before);
}

TEST(Latent, LineBetweenTwoCodes) {
  Library const library = four_codes();
  Shape const &a = library.shape[0], &b = library.shape[2];
  EXPECT_EQ(interpolate_codes(a, b, 0), a.code);
  EXPECT_EQ(interpolate_codes(a, b, 1), b.code);
  EXPECT_EQ(interpolate_codes(a, b, 0.25), (std::vector<float>{0.75f, 0, 1, 2, 5}));
  EXPECT_THROW(interpolate_codes(a, coded("x/0", {1, 2}, 1), 0.5), std::invalid_argument);
  EXPECT_THROW(interpolate_codes(a, Shape{}, 0.5), std::invalid_argument);
}

TEST(Latent, BadRequestsAreNamed) {
  Library library = four_codes();
  try {
    fit_codes(library, "snad");
    FAIL();
  } catch (std::invalid_argument const& e) {
    EXPECT_NE(std::string(e.what()).find("sand, rock"), std::string::npos) << e.what();
  }
  EXPECT_THROW(fit_codes(library, "rock"), std::invalid_argument);  // one code
  EXPECT_THROW(fit_codes(library, "sand", 1), std::invalid_argument);
  library.shape[1].net = 1;
  EXPECT_THROW(fit_codes(library, "sand"), std::invalid_argument);
  Random random(1);
  EXPECT_THROW(draw_code(fit_codes(four_codes(), "sand"), 0, random), std::invalid_argument);
}

}  // namespace
}  // namespace scree
