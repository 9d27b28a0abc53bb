// rolling_entries.cpp: rows 5 and 6 of the book: a sphere that slides, rolls, or does both on an incline.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/simulation.h"
#include "tests/support/cases.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr radius = 0.05, gravity = 9.81;                                     // [m], [m/s2]
double const mass = 2650 * 4.0 / 3 * M_PI * std::pow(radius, 3);                    // [kg]
double const kappa = 2e6 / (M_PI * 0.025 * 1e-3);                                   // [N/m3], of rock_case
double sunk(double weight) { return std::sqrt(weight / (M_PI * radius * kappa)); }  // F = pi R kappa overlap^2 [m]

// A sphere on a plane that already carries `weight` [N].
Case sphere_on_plane(double weight, double friction) {
  Case c = rock_case();
  c.contact[0].friction = friction;
  c.contact[0].damping_ratio = 0.5;
  c.grains = {grains_at("sphere", {{0, 0, radius - sunk(weight)}})};
  c.wall = {floor_at(0)};
  return c;
}

TEST(Validation, Row5SphereSlidesThenRolls) {
  Entry book("validation", "5", "sphere slides, then rolls", "closed form: momentum about the contact is kept");
  double const mu = 0.3, u = 1;
  Case c = sphere_on_plane(mass * gravity, mu);
  c.gravity = Vec3{0, 0, -gravity};
  c.grains[0].insert.velocity = {u, 0, 0};
  c.time.end = 0.3;
  Simulation s(c, {});
  double rolling_since = -1, next = 0;
  double const rolls_at = 2 * u / (7 * mu * gravity);
  while (s.step() == RunState::running) {
    Frame const f = s.frame();
    if (rolling_since < 0 && f.velocity[0].x - f.spin[0].y * radius < 1e-3 * u) rolling_since = s.time();
    if (s.time() >= next) {
      book.point("speed [m/s] against time [s]", s.time(), std::max(5.0 / 7 * u, u - mu * gravity * s.time()),
                 f.velocity[0].x);
      next += 0.01;
    }
  }
  book.relative("speed when it rolls", "m/s", 5.0 / 7 * u, s.frame().velocity[0].x, 0.01);
  book.relative("rolls from", "s", rolls_at, rolling_since, 0.01);
  book.at_most("ledger residual of the energy moved", "", std::abs(s.ledger().residual) / s.ledger().moved, 1e-3);
}

TEST(Validation, Row6SphereOnAnIncline) {
  Entry book("validation", "6", "sphere on an incline rolls or slides", "closed form");
  double const slope = 0.5;  // [rad]
  for (double mu : {0.8, 0.05}) {
    Case c = sphere_on_plane(mass * gravity * std::cos(slope), mu);
    c.gravity = Vec3{gravity * std::sin(slope), 0, -gravity * std::cos(slope)};
    c.time.end = 0.2;
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    bool const rolls = mu >= 2.0 / 7 * std::tan(slope);
    double const a = rolls ? 5.0 / 7 * gravity * std::sin(slope) : gravity * (std::sin(slope) - mu * std::cos(slope));
    book.relative(rolls ? "acceleration, friction 0.8 (rolls)" : "acceleration, friction 0.05 (slides)", "m/s2", a,
                  s.frame().velocity[0].x / s.time(), 0.01);
  }
}

}  // namespace
}  // namespace scree::book
