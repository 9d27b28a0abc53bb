// long_run_entries.cpp: many steps at rest and of free rotation: drift per million steps.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard/course.h"

namespace scree::book {
namespace {

using namespace testing;

std::int64_t steps() { return full() ? 1000000 : 10000; }

TEST(Hard, ManyStepsAtRest) {
  Entry book("hard", "rest", "a block and a stone at rest for many steps", "nothing moves them");
  double const d = 0.1, side = d * std::cbrt(M_PI / 6), g = 9.81;
  for (char const* shape : {"box:1:1:1", "ellipsoid:1:0.8:0.6"}) {
    Case c = rock_case();
    c.gravity = Vec3{0, 0, -g};
    c.contact[0].damping_ratio = 0.7;
    c.contact[0].friction = 0.5;
    double const kappa = 2e6 / (M_PI * 0.025 * 1e-3), weight = 2650 * M_PI / 6 * d * d * d * g;
    bool const box = std::string(shape).substr(0, 3) == "box";
    double const height = box ? side / 2 - weight / (kappa * side * side) : 0.5 * d * 0.6 / std::cbrt(0.48);
    c.grains = {grains_at(shape, {{0, 0, height}}, d, 1000)};
    c.wall = {floor_at(0)};
    c.time.settle = SettleCase{20, 0, 1e-30, 1e9};  // damps all the time ...
    c.time.end = 1e9;
    Simulation s(c, {});
    while (s.time() < (full() ? 4 : 1)) s.step();
    s.impl().c.time.settle->damping = 0;  // ... until here
    double const released = s.largest_kinetic_per_grain();
    Frame const start = s.frame();
    LedgerRow const before = s.ledger();
    std::int64_t const first = s.steps();
    double kinetic = 0;
    while (s.steps() < first + steps()) {
      s.step();
      kinetic = std::max(kinetic, s.largest_kinetic_per_grain());
    }
    double const millions = static_cast<double>(steps()) * 1e-6;
    double const drift = norm(s.frame().position[0] - start.position[0]) / d / millions;
    double const energy = std::abs(mechanical_energy(s.ledger()) - mechanical_energy(before)) / (weight * d) / millions;
    std::string const name = box ? "block" : "stone";
    book.trend(name + ": kinetic energy when damping ends", "m g d", released);
    book.at_most(name + ": drift of position", "d per million steps", drift, 1e-6);
    book.at_most(name + ": drift of energy", "m g d per million steps", energy, 1e-6);
    book.at_most(name + ": largest kinetic energy", "m g d", kinetic, 1e-11);
  }
}

// Symplectic splitting: the energy error stays within a band that falls with the square of the step, L is state.
TEST(Hard, ManyStepsOfFreeRotation) {
  Entry book("hard", "spin", "free rotation of a box 1:2:3 for many steps", "energy and angular momentum are kept");
  Case c = rock_case();
  c.grains = {grains_at("box:1:2:3", {{}}, 0.1, 32)};
  c.grains[0].insert.spin = {1, 20, 1};
  c.time.step = 1e-4;
  c.time.end = static_cast<double>(steps() + 1) * 1e-4;
  Simulation s(c, {});
  Vec3 const l0 = s.impl().state.angular_momentum[0];
  double const e0 = s.ledger().kinetic;
  double first = 0, last = 0;
  while (s.steps() < steps()) {
    s.step();
    double const off = std::abs(s.ledger().kinetic / e0 - 1);
    (s.steps() < steps() / 2 ? first : last) = std::max(s.steps() < steps() / 2 ? first : last, off);
  }
  book.at_most("angular momentum, relative change", "", norm(s.impl().state.angular_momentum[0] - l0) / norm(l0),
               1e-14);
  book.at_most("energy, largest relative error", "", std::max(first, last), 1e-6);
  book.at_most("energy error, second half over the first: no drift", "", last / first, 1.1);
  Quat const q = s.impl().state.orientation[0];
  book.absolute("length of the quaternion", "", 1, std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z), 1e-14);
}

}  // namespace
}  // namespace scree::book
