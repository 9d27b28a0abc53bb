// rolling_test.cpp: rolling resistance of closed-form and node-covered spheres: holds, rolls, rings down; on and off.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/support/contact_sets.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = 3.141592653589793, g = 9.81, d = 0.1, r = d / 2;
double constexpr mass = 2650 * pi / 6 * d * d * d;
double constexpr kappa = 2e6 / (pi * (d / 4) * 0.01 * d);

double sunk(double load) { return std::sqrt(load / (pi * r * kappa)); }

// A ball at rest on a plane that is inclined by theta: x points downhill.
Case incline(char const* shape, double theta, double rolling, int nodes = 4000) {
  Case c = rock_case();
  c.gravity = Vec3{g * std::sin(theta), 0, -g * std::cos(theta)};
  c.contact[0].friction = 0.9;
  c.contact[0].damping_ratio = 0.5;
  c.contact[0].rolling = RollingCase{rolling};
  c.grains = {grains_at(shape, {{0, 0, r - sunk(mass * g * std::cos(theta))}}, d, nodes)};
  c.wall = {floor_at(0)};
  c.time.end = 0.3;
  return c;
}

void run(Simulation& s) {
  while (s.step() == RunState::running) {
  }
}

// tan(theta) = mu_r is the limit of rest; beyond it a = 5/7 g (sin - mu_r cos). Nodes stick by themselves up to the
// part of a node spacing that the contact's edge has to travel: at 4,000 nodes 0.02 of a radius.
TEST(Rolling, ASphereOnAnInclineHoldsBelowMuAndRollsAbove) {
  double const mu = 0.3;
  for (char const* shape : {"sphere", "ellipsoid:1:1:1"}) {
    bool const nodes = std::string(shape) != "sphere";
    Simulation holds(incline(shape, std::atan(0.95 * mu), mu), {});
    run(holds);
    EXPECT_LT(norm(holds.frame().velocity[0]), 1e-4) << shape;
    EXPECT_LT(holds.frame().position[0].x, 0.02 * r) << shape;
    double const theta = std::atan(1.5 * mu);
    Simulation rolls(incline(shape, theta, mu), {});
    run(rolls);
    double const a = 5.0 / 7 * g * (std::sin(theta) - mu * std::cos(theta));
    EXPECT_NEAR(rolls.frame().velocity[0].x / (a * rolls.time()), 1, nodes ? 0.1 : 0.02) << shape;
    for (Simulation* s : {&holds, &rolls}) EXPECT_LT(std::abs(s->ledger().residual), 1e-3 * s->ledger().moved) << shape;
    // All of the couple's loss is at its limit mu_r R F times the angle rolled.
    double const angle = rolls.frame().position[0].x / r;
    EXPECT_NEAR(rolls.ledger().rolling / (mu * r * mass * g * std::cos(theta) * angle), 1, nodes ? 0.1 : 0.02) << shape;
  }
}

// The history is one entry a pair and outlives a new pair list.
TEST(Rolling, HistorySurvivesNewPairLists) {
  for (char const* shape : {"sphere", "ellipsoid:1:1:1"}) {
    Case c = incline(shape, std::atan(0.2), 0.3, 1000);
    c.grains[0].insert.position.push_back({0, 0.0999, 0.05});
    c.grains[0].count = 2;
    c.time.end = 0.1;
    Simulation kept(c, {}), rebuilt(c, {.brute_force = true});  // brute force makes a new pair list every step
    run(kept);
    run(rebuilt);
    EXPECT_EQ(kept.frame().position, rebuilt.frame().position) << shape;
    EXPECT_GT(kept.ledger().elastic_rolling, 0) << shape;
    EXPECT_EQ(kept.ledger().elastic_rolling, rebuilt.ledger().elastic_rolling) << shape;
    EXPECT_GT(rebuilt.impl().work.pair_rebuilds, kept.impl().work.pair_rebuilds + 10);
  }
}

// Below the limit the ball rocks: m x" = -k_t (x - R theta), I theta" = k_t R (x - R theta) - k_r theta, whose slow
// mode with l = m omega^2 / k_t, a = k_r / (k_t R^2) is 0.4 l^2 - (1.4 + a) l + a = 0. Without the dashpot the couple
// loses nothing; with it swings fall by exp(-pi eta / sqrt(1 - eta^2)) each, less the tangential spring's part (a =
// 0.18). Contact damping only stills the fast mode of that spring.
TEST(Rolling, ABallRocksAndRingsDown) {
  double const mu = 0.2, load = mass * g, k = 2 * pi * r * kappa * sunk(load);
  double const k_r = 2.25 * k * mu * mu * r * r, k_t = 0.5 * k, a = k_r / (k_t * r * r);
  double const l = (1.4 + a - std::sqrt((1.4 + a) * (1.4 + a) - 1.6 * a)) / 0.8, omega = std::sqrt(l * k_t / mass);
  for (double eta : {0.0, 0.1}) {
    Case c = incline("sphere", 0, mu);
    c.contact[0].damping_ratio = 0.2;
    c.contact[0].rolling->damping = eta;
    double const swing = 0.3 * mu * r * load / k_r;  // well below the limit
    c.grains[0].insert.velocity = {swing * omega * r, 0, 0};
    c.grains[0].insert.spin = {0, swing * omega, 0};
    c.time.end = 4 * 2 * pi / omega;
    c.time.safety = 0.1;
    Simulation s(c, {});
    std::vector<double> largest, crossing;  // of |spin| between zero crossings; when [s]
    double before = 1, most = 0;
    while (s.step() == RunState::running) {
      double const spin = s.frame().spin[0].y;
      most = std::max(most, std::abs(spin));
      if (spin * before < 0) largest.push_back(most), crossing.push_back(s.time()), most = 0;
      before = spin;
    }
    ASSERT_GE(largest.size(), 6u);
    double const swings = static_cast<double>(crossing.size() - 2);  // the first one starts the fast mode
    double const period = 2 * (crossing.back() - crossing[1]) / swings;
    EXPECT_NEAR(period / (2 * pi / omega), 1, 0.01) << "eta " << eta;
    double const decay = std::log(largest[1] / largest.back()) / swings;
    EXPECT_NEAR(decay, pi * eta / std::sqrt(1 - eta * eta), 0.02 + 0.18 * pi * eta) << "eta " << eta;
    EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved);
    if (eta == 0) {
      EXPECT_LT(std::abs(s.ledger().rolling), 1e-3 * s.ledger().moved);
    }
  }
}

// Two grains meet off-centre with spin: the couple is opposite on both, so the angular momentum stays.
TEST(Rolling, CouplesKeepTheAngularMomentum) {
  for (char const* shape : {"sphere", "ellipsoid:1:0.8:0.6"}) {
    Case c = rock_case();
    c.contact[0].friction = 0.5;
    c.contact[0].rolling = RollingCase{0.3};
    GrainsCase a = grains_at(shape, {{-0.055, 0.01, 0}}), b = grains_at(shape, {{0.055, 0, 0}}, 0.08);
    b.name = "other";
    a.insert.velocity = {1, 0, 0};
    a.insert.spin = {3, 20, -5};
    c.grains = {a, b};
    c.time.end = 0.05;
    Simulation s(c, {});
    auto const angular = [&] {
      Vec3 sum;
      for (int i = 0; i < 2; ++i)
        sum += s.impl().state.angular_momentum[i] +
               cross(s.impl().state.position[i], s.impl().state.velocity[i] * s.impl().scene.mass[i]);
      return sum;
    };
    Vec3 const before = angular();
    double measured = 0;
    while (s.step() == RunState::running)
      for (RollingResult const& roll : s.impl().work.rolling) measured += roll.loss;
    EXPECT_LT(norm(angular() - before), 1e-10 * norm(before)) << shape;
    EXPECT_GT(s.ledger().rolling, 0) << shape;
    // Work over a step is taken at two velocities half a step apart, and what is stored as the contact opens is lost.
    EXPECT_NEAR(measured, s.ledger().rolling, 0.05 * s.ledger().rolling) << shape;
    EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved) << shape;
  }
}

// Absent or of zero strength: the same plan, launches and bits.
TEST(Rolling, OffIsAbsent) {
  for (char const* shape : {"sphere", "ellipsoid:1:0.9:1"}) {
    Case off = incline(shape, 0.3, 0, 500), zero = off, on = off;
    off.contact[0].rolling.reset();
    on.contact[0].rolling->friction = 0.1;
    for (Case* c : {&off, &zero, &on}) c->time.end = 0.05;
    Simulation s(off, {}), z(zero, {}), o(on, {});
    for (Simulation* each : {&s, &z, &o}) run(*each);
    EXPECT_EQ(s.frame().position, z.frame().position);
    EXPECT_EQ(s.frame().orientation, z.frame().orientation);
    EXPECT_EQ(launches(s), launches(z));
    EXPECT_NE(s.frame().position, o.frame().position);
    Plan const a = s.plan(), b = z.plan(), with = o.plan();
    EXPECT_EQ(a.stages, b.stages);
    EXPECT_EQ(a.effects, b.effects);
    EXPECT_EQ(a.law, b.law);
    EXPECT_EQ(a.step, b.step);
    ASSERT_EQ(a.arrays.size(), b.arrays.size());
    for (std::size_t i = 0; i < a.arrays.size(); ++i) {
      EXPECT_EQ(a.arrays[i].name, b.arrays[i].name);
      EXPECT_EQ(a.arrays[i].bytes, b.arrays[i].bytes);
    }
    EXPECT_TRUE(z.impl().work.rolling.empty() && z.impl().state.wrench.rolling.empty());
    EXPECT_EQ(std::count(a.effects.begin(), a.effects.end(), "rolling resistance"), 0);
    EXPECT_EQ(std::count(with.effects.begin(), with.effects.end(), "rolling resistance"), 1);
    EXPECT_EQ(with.stages, a.stages) << "it is a part of the contact stages, not a stage";
    EXPECT_EQ(with.arrays.back().name, "rolling history");
    EXPECT_EQ(with.arrays.size(), a.arrays.size() + 1);
    EXPECT_EQ(s.results_header().ledger, z.results_header().ledger);
    EXPECT_EQ(o.results_header().ledger.size(), s.results_header().ledger.size() + 2);
  }
}

}  // namespace
}  // namespace scree
