// harmonics_test.cpp: closed forms, orthonormality, differences of the gradient, poles and centre.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/harmonics.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <vector>

namespace scree {
namespace {

double constexpr pi = std::numbers::pi;

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> u;
  return normalized(Vec3{u(random), u(random), u(random)});
}

std::vector<double> random_radius(int degree, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<double> c(harmonic_count(degree));
  // The addition theorem bounds the sum of degree l by sqrt((2l + 1) / 4 pi) |c_l|: r stays positive.
  for (int l = 1; l <= degree; ++l)
    for (int m = -l; m <= l; ++m) c[harmonic_index(l, m)] = 0.1 * u(random) / (l + 1) / (l + 1);
  c[0] = 0.5 * std::sqrt(4 * pi);
  return c;
}

TEST(Harmonics, CountsAndOrder) {
  EXPECT_EQ(harmonic_count(10), 121);
  EXPECT_EQ(harmonic_index(0, 0), 0);
  EXPECT_EQ(harmonic_index(1, -1), 1);
  EXPECT_EQ(harmonic_index(2, 2), 8);
  EXPECT_EQ(harmonic_degree(121), 10);
  EXPECT_EQ(harmonic_degree(1), 0);
  EXPECT_EQ(harmonic_degree(120), -1);
  EXPECT_EQ(harmonic_degree(0), -1);
}

TEST(Harmonics, LowDegreesAreTheirPolynomials) {
  std::mt19937 random(1);
  std::vector<double> y(harmonic_count(2));
  for (int i = 0; i < 50; ++i) {
    Vec3 const n = random_direction(random);
    harmonics(2, n, y);
    double const one = std::sqrt(3 / (4 * pi)), two = std::sqrt(15 / (4 * pi));
    double const expected[9] = {std::sqrt(1 / (4 * pi)),
                                one * n.y,
                                one * n.z,
                                one * n.x,
                                two * n.x * n.y,
                                two * n.y * n.z,
                                std::sqrt(5 / (16 * pi)) * (3 * n.z * n.z - 1),
                                two * n.x * n.z,
                                two / 2 * (n.x * n.x - n.y * n.y)};
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(y[k], expected[k], 1e-15) << k;
  }
}

TEST(Harmonics, SectoralsOfHighDegree) {
  // Y(m, m) = sqrt2 sqrt((2m + 1)!! / (4 pi (2m)!!)) sin^m cos(m psi)
  int constexpr degree = 20;
  std::vector<double> y(harmonic_count(degree));
  double const psi = 0.7, theta = 1.1;
  harmonics(degree, {std::sin(theta) * std::cos(psi), std::sin(theta) * std::sin(psi), std::cos(theta)}, y);
  double factor = 1 / (4 * pi);
  for (int m = 1; m <= degree; ++m) {
    factor *= (2.0 * m + 1) / (2 * m);
    double const amplitude = std::sqrt(2 * factor) * std::pow(std::sin(theta), m);
    EXPECT_NEAR(y[harmonic_index(m, m)], amplitude * std::cos(m * psi), 1e-14) << m;
    EXPECT_NEAR(y[harmonic_index(m, -m)], amplitude * std::sin(m * psi), 1e-14) << m;
  }
}

// Gauss-Legendre in z times a uniform sum in psi integrates products of two degrees <= 20 exactly.
TEST(Harmonics, AreOrthonormal) {
  int constexpr degree = 20, rows = 21, columns = 42, count = (degree + 1) * (degree + 1);
  std::vector<double> gram(count * count, 0.0), y(count);
  for (int i = 0; i < rows; ++i) {
    double z = std::cos(pi * (i + 0.75) / (rows + 0.5)), slope = 1;  // Newton for the zeros of the Legendre polynomial
    for (int iteration = 0; iteration < 20; ++iteration) {
      double p = 1, before = 0;
      for (int l = 1; l <= rows; ++l) {
        double const next = ((2 * l - 1) * z * p - (l - 1) * before) / l;
        before = p, p = next;
      }
      slope = rows * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    double const weight = 2 / ((1 - z * z) * slope * slope) * 2 * pi / columns, s = std::sqrt(1 - z * z);
    for (int j = 0; j < columns; ++j) {
      double const psi = 2 * pi * j / columns;
      harmonics(degree, {s * std::cos(psi), s * std::sin(psi), z}, y);
      for (int a = 0; a < count; ++a)
        for (int b = 0; b <= a; ++b) gram[a * count + b] += weight * y[a] * y[b];
    }
  }
  for (int a = 0; a < count; ++a)
    for (int b = 0; b <= a; ++b) EXPECT_NEAR(gram[a * count + b], a == b, 1e-12) << a << " " << b;
}

TEST(Harmonics, RadiusIsTheSumOfTheBasisAndItsGradientTheDerivative) {
  std::mt19937 random(2);
  for (int degree : {0, 1, 2, 5, 10, 12, 20}) {
    std::vector<double> const c = random_radius(degree, degree);
    std::vector<double> y(c.size());
    for (int i = 0; i < 20; ++i) {
      Vec3 const n = random_direction(random);
      harmonics(degree, n, y);
      double sum = 0;
      for (std::size_t k = 0; k < c.size(); ++k) sum += c[k] * y[k];
      Vec3 gradient;
      EXPECT_NEAR(harmonic_radius(c, n, &gradient), sum, 1e-14);
      EXPECT_NEAR(dot(gradient, n), 0, 1e-13);
      double const h = 1e-6;
      for (int k = 0; k < 3; ++k) {
        Vec3 plus = n, minus = n;
        plus[k] += h, minus[k] -= h;
        double const difference =
            (harmonic_radius(c, normalized(plus), nullptr) - harmonic_radius(c, normalized(minus), nullptr)) / (2 * h);
        EXPECT_NEAR(gradient[k], difference, 1e-8) << degree;
      }
    }
  }
}

TEST(RadialDistance, GradientIsTheDerivative) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<double> const c = random_radius(10, 4);
  for (int i = 0; i < 100; ++i) {
    Vec3 const x{u(random), u(random), u(random)};
    if (norm(x) < 0.05) continue;
    Vec3 gradient;
    radial_distance(c, x, &gradient);
    EXPECT_GE(norm(gradient), 1 - 1e-12);
    double const h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      Vec3 plus = x, minus = x;
      plus[k] += h, minus[k] -= h;
      double const difference = (radial_distance(c, plus, nullptr) - radial_distance(c, minus, nullptr)) / (2 * h);
      EXPECT_NEAR(gradient[k], difference, 1e-7);  // h^2 times the third derivative, (degree / |x|)^3 / 1e2
    }
  }
}

TEST(RadialDistance, OfASphereIsItsDistance) {
  std::vector<double> const c = {0.5 * std::sqrt(4 * pi)};
  for (Vec3 x : {Vec3{0.1, 0.2, -0.3}, Vec3{1, -2, 3}, Vec3{0, 0, 0.2}, Vec3{0, 0, -2}, Vec3{0, 0, 0}}) {
    Vec3 gradient;
    EXPECT_NEAR(radial_distance(c, x, &gradient), 0.5 - norm(x), 1e-15);
    if (norm(x) > 0) {
      EXPECT_LT(norm(gradient + normalized(x)), 1e-15);
    }
  }
}

// On the z axis every term with m > 1 and its slope vanish; phi must have one limit from all sides.
TEST(RadialDistance, IsSmoothAtThePoles) {
  std::vector<double> const c = random_radius(12, 5);
  for (double z : {0.4, -0.4}) {
    Vec3 at_pole;
    double const phi = radial_distance(c, {0, 0, z}, &at_pole);
    EXPECT_TRUE(is_finite(at_pole));
    for (double psi : {0.0, 1.0, 2.5, 4.0}) {
      Vec3 gradient;
      double const e = 1e-7;
      EXPECT_NEAR(radial_distance(c, {e * std::cos(psi), e * std::sin(psi), z}, &gradient), phi, 10 * e);
      EXPECT_LT(norm(gradient - at_pole), 100 * e);
    }
  }
}

TEST(RadialDistance, AtTheCentreIsTheMeanRadius) {
  std::vector<double> const c = random_radius(6, 6);
  Vec3 gradient{1, 1, 1};
  EXPECT_NEAR(radial_distance(c, {}, &gradient), 0.5, 1e-15);
  EXPECT_EQ(gradient, Vec3{});
}

}  // namespace
}  // namespace scree
