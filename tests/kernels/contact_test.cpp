// contact_test.cpp: restitution curves, contact laws and cohesion, the spring that slides.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "kernels/contact_laws.h"
#include "kernels/integrate.h"
#include "kernels/restitution.h"
#include "kernels/tangential.h"

namespace scree {
namespace {

TEST(Restitution, NodesFollowTheDesignsTable) {
  // Design physics.md section 2, three digits given.
  double const table[][2] = {{.1, .726}, {.2, .556}, {.3, .440}, {.4, .357}, {.5, .296},
                             {.6, .249}, {.7, .213}, {.8, .184}, {1.0, .141}};
  for (auto const& [zeta, e] : table) EXPECT_NEAR(restitution_of(zeta, DampingPath::nodes), e, 6e-4) << zeta;
  EXPECT_NEAR(restitution_of(0, DampingPath::nodes), 1, 1e-6);
}

TEST(Restitution, InverseReturnsTheRatio) {
  for (DampingPath path : {DampingPath::nodes, DampingPath::sphere})
    for (double zeta : {0.05, 0.3, 0.7, 1.5})
      EXPECT_NEAR(damping_ratio_for(restitution_of(zeta, path), path), zeta, 1e-4);
  EXPECT_EQ(damping_ratio_for(1, DampingPath::nodes), 0);
  for (double e : {0.0, -0.1, 1.1}) EXPECT_THROW(damping_ratio_for(e, DampingPath::nodes), std::invalid_argument);
}

// A force F ~ x^n damped by 2 zeta sqrt(m K) is, in the coordinate sqrt(2 U), the linear oscillator with
// zeta_eff = zeta sqrt(2 n / (n + 1)); released where the force would pull (Schwager, Poeschel, Granul. Matter 9 (2007)
// 465, eq. 20): tan(damped phase) = 2 z sqrt(1 - z^2) / (2 z^2 - 1) there.
double clipped_oscillator(double z) {
  double const w = std::sqrt(1 - z * z);
  return std::exp(-z / w * std::atan2(2 * z * w, 2 * z * z - 1));
}

TEST(Restitution, ClosedFormOfEachLawIsTheClippedOscillator) {
  for (auto const& [law, n] :
       {std::pair{ContactLaw::winkler, 2.0}, {ContactLaw::linear, 1.0}, {ContactLaw::hertz, 1.5}})
    for (double zeta : {0.05, 0.2, 0.5, 0.8})
      EXPECT_NEAR(restitution_of(zeta, DampingPath::sphere, law), clipped_oscillator(zeta * std::sqrt(2 * n / (n + 1))),
                  1e-3)
          << static_cast<int>(law) << ", zeta " << zeta;
}

TEST(Restitution, EachLawInverts) {
  for (ContactLaw law : {ContactLaw::linear, ContactLaw::hertz})
    for (DampingPath path : {DampingPath::nodes, DampingPath::sphere})
      for (double e : {0.2, 0.5, 0.9}) {
        EXPECT_NEAR(restitution_of(damping_ratio_for(e, path, law), path, law), e, 1e-4);
        EXPECT_NEAR(restitution_of(0, path, law), 1, 1e-4);
      }
}

TEST(ContactLaws, EveryFunctionIsTheDerivativeOfTheNextAndContinuousAtTheOnset) {
  PressureLaw const linear{ContactLaw::linear, 3e7, 1e-4, 1e-3}, hertz{ContactLaw::hertz, 5e9, 1e-5, 1e-3};
  for (PressureLaw const& law : {PressureLaw{ContactLaw::winkler, 3e9}, linear, hertz}) {
    double const around = law.onset > 0 ? law.onset : 1e-4;
    SphereLaw const sphere{law, 0.02};
    for (double x : {0.3 * around, 0.9 * around, 1.1 * around, 30 * around}) {
      double const h = 1e-4 * x;
      auto const rate = [&](auto f) { return (f(x + h) - f(x - h)) / (2 * h); };
      EXPECT_NEAR(rate([&](double y) { return law.energy_integral(y); }) / law.energy(x), 1, 1e-7);
      EXPECT_NEAR(rate([&](double y) { return law.energy(y); }) / law.pressure(x), 1, 1e-7);
      EXPECT_NEAR(rate([&](double y) { return law.pressure(y); }), law.slope(x), 1e-7 * law.slope(0));
      EXPECT_NEAR(rate([&](double y) { return sphere.energy(y); }) / sphere.force(x), 1, 1e-7);
      EXPECT_NEAR(rate([&](double y) { return sphere.force(y); }) / sphere.stiffness(x), 1, 1e-7);
    }
    double const below = around * (1 - 1e-12), above = around * (1 + 1e-12);
    EXPECT_NEAR(law.pressure(below) / law.pressure(above), 1, 1e-11);
    EXPECT_NEAR(law.energy(below) / law.energy(above), 1, 1e-11);
    EXPECT_NEAR(law.energy_integral(below) / law.energy_integral(above), 1, 1e-11);
  }
}

TEST(Cohesion, EveryFunctionIsTheDerivativeOfTheNextAndVanishesBeyondTheReach) {
  Cohesion const stick{1e4, 1e-4};
  for (double x : {-1.05e-4, -0.95e-4, -0.5e-4, 0.5e-4}) {
    double const h = 1e-9;
    auto const rate = [&](auto f) { return (f(x + h) - f(x - h)) / (2 * h); };
    EXPECT_NEAR(rate([&](double y) { return stick.energy_integral(y); }) / stick.energy(x), 1, 1e-6);
    EXPECT_NEAR(rate([&](double y) { return stick.energy(y); }) / stick.pressure(x), 1, 1e-6);
    EXPECT_NEAR(rate([&](double y) { return stick.pressure(y); }), -stick.slope(x),
                1e-6 * stick.traction / stick.ramp());
  }
  EXPECT_NEAR(stick.energy(0), -stick.traction * stick.range, 1e-12);
  EXPECT_EQ(stick.pressure(-1.1001e-4), 0);
  EXPECT_EQ(stick.energy_integral(-1.1001e-4), 0);
  EXPECT_EQ(Cohesion{}.energy(1e-3), 0);
}

TEST(ContactLaws, ParametersMeanWhatTheirNamesSay) {
  double const d = 0.1, k = 2e6, e = 1e9, nu = 0.25, deep = 1e-3;
  // Equal spheres: slope k_n beyond the onset; Hertz's F = 4/3 E* sqrt(R) x^(3/2) with E* = E / (2 (1 - nu^2)).
  PressureLaw const linear{ContactLaw::linear, linear_modulus(k, d), 1e-3 * d, 0.01 * d};
  EXPECT_NEAR((SphereLaw{linear, d / 4}.stiffness(deep)) / k, 1, 1e-12);
  PressureLaw const hertz{ContactLaw::hertz, hertz_modulus(e, nu), 1e-12 * d, 0.01 * d};
  for (double radius : {d / 4, d / 2})
    EXPECT_NEAR((SphereLaw{law_at_radius(hertz, radius), radius}.force(deep)) /
                    (4.0 / 3 * e / (2 * (1 - nu * nu)) * std::sqrt(radius) * std::pow(deep, 1.5)),
                1, 1e-9);
}

TEST(WinklerLaw, PressureAndSlopeAreDerivativesOfTheEnergy) {
  PressureLaw const law{ContactLaw::winkler, 3e9};
  SphereLaw const sphere{law, 0.02};
  double const x = 1e-4, h = 1e-8;
  EXPECT_NEAR((law.energy(x + h) - law.energy(x - h)) / (2 * h) / law.pressure(x), 1, 1e-8);
  EXPECT_NEAR((law.pressure(x + h) - law.pressure(x - h)) / (2 * h) / law.slope(x), 1, 1e-8);
  EXPECT_NEAR((sphere.energy(x + h) - sphere.energy(x - h)) / (2 * h) / sphere.force(x), 1, 1e-7);
  EXPECT_NEAR((sphere.force(x + h) - sphere.force(x - h)) / (2 * h) / sphere.stiffness(x), 1, 1e-7);
  // The case file's k_n: secant stiffness of two equal spheres at the reference overlap.
  double const d = 0.1, k = 2e6, at = 0.01 * d;
  EXPECT_NEAR((SphereLaw{{ContactLaw::winkler, winkler_modulus(k, d, at)}, d / 4}.force(at) / at), k, 1e-6 * k);
}

// The series below 0.1 rad and the matrix above it are the same turn, right up to where one takes over from the other.
TEST(Tangential, OneVectorTurnsLikeTheMatrix) {
  Vec3 const x{0.3, -1.2, 0.7}, axis = normalized(Vec3{1, 2, -0.5});
  for (double angle : {0.0, 1e-9, 1e-4, 0.03, 0.0999999, 0.1000001, 0.4, 3.0}) {
    // Rodrigues' formula.
    Vec3 const expected =
        x * std::cos(angle) + cross(axis, x) * std::sin(angle) + axis * (dot(axis, x) * (1 - std::cos(angle)));
    EXPECT_LT(norm(turned_by(axis * angle, x) - expected), 1e-15 * 4) << angle;
  }
  Vec3 const n{0, 0, 1};
  Vec3 const flat = laid_flat({3, 0, 4}, n);
  EXPECT_NEAR(flat.x, 5, 1e-14);
  EXPECT_EQ(flat.z, 0);
  EXPECT_EQ(norm(laid_flat({}, n)), 0);
  EXPECT_EQ(norm(laid_flat({0, 0, 2}, n)), 0);  // nothing of it lies in the plane
}

// A ball turns about its fixed axis by spin times time; a body that is all but a ball, by the general path, alike.
TEST(FreeRotation, OfABallIsOneTurn) {
  double const inertia = 2e-3, dt = 1e-3;
  Vec3 const spin{30, -20, 50};
  Quat ball = normalized(Quat{0.5, 0.1, -0.7, 0.3}), other = ball;
  Quat const start = ball;
  for (int i = 0; i < 1000; ++i) {
    ball = rotate_free(ball, {inertia, inertia, inertia}, spin * inertia, dt);
    other = rotate_free(other, {inertia, inertia, inertia * (1 + 1e-9)}, spin * inertia, dt);
  }
  Quat const expected = quat_from_rotation_vector(spin * (1000 * dt)) * start;
  auto const apart = [](Quat a, Quat b) { return 1 - std::abs(a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z); };
  EXPECT_LT(apart(ball, expected), 1e-14);
  // The splitting turns about three axes one after the other: wrong by less than (spin dt)^2 / 12 of the angle.
  double const turned = norm(spin) * 1000 * dt, wrong = turned * norm2(spin * dt) / 12;
  EXPECT_LT(apart(other, expected), wrong * wrong / 8);
  EXPECT_GT(apart(other, expected), 0.01 * wrong * wrong / 8);  // it is another path indeed
}

TEST(Tangential, SpringSticksThenSlides) {
  double const dt = 1e-3, limit = 1e-4;
  Vec3 const v{0.01, 0, 0};
  Vec3 xi;
  double lost = 0;
  for (int i = 0; i < 100; ++i) {
    TangentialResult const t = slide(xi, v, dt, 0, limit);
    xi = t.xi;
    lost += t.loss;
  }
  EXPECT_DOUBLE_EQ(xi.x, limit);
  // Travel beyond the stick range slides at the limit: loss = limit * (travel - limit).
  EXPECT_NEAR(lost, limit * (100 * dt * v.x - limit), 1e-15);
  // With a dashpot the traction never passes the limit.
  EXPECT_LE(norm(slide(xi, v, dt, 10, limit).traction), limit * (1 + 1e-12));
  EXPECT_EQ(norm(slide({}, v, dt, 0, 0).xi), 0);
}

}  // namespace
}  // namespace scree
