// sphere_physics_test.cpp: spheres in closed form: elastic impact, sizes, empty scenes, watches; what a plan holds.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = 3.141592653589793;

TEST(SpherePhysics, DropHasOnlyTheStagesItNeeds) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.grains = {grains_at("sphere", {{0, 0, 0.2}})};
  c.wall = {floor_at(0)};
  Plan const plan = Simulation(c, {}).plan();
  EXPECT_EQ(plan.stages,
            (std::vector<std::string>{"bounds", "broad_phase", "sphere_contacts", "gravity", "integrate", "watch"}));
  for (Plan::Array const& array : plan.arrays) {
    EXPECT_NE(array.name, "contact history");
    EXPECT_NE(array.name, "surface nodes");
  }
}

// Undamped impact on a plane: m v^2/2 = pi R kappa overlap^3 / 3 gives the deepest point; it rebounds at full speed.
TEST(SpherePhysics, ElasticImpactReachesTheClosedFormOverlapAndReturns) {
  Case c = rock_case();
  c.contact[0].kappa = 1e10;
  GrainsCase g = grains_at("sphere", {{0, 0, 0.051}});
  g.insert.velocity = {0, 0, -1};
  c.grains = {g};
  c.wall = {floor_at(0)};
  c.time.end = 0.02;
  c.time.safety = 0.02;
  Simulation s(c, {});
  double deepest = 0;
  while (s.step() == RunState::running) deepest = std::max(deepest, s.largest_overlap() * 0.1);
  double const m = 2650 * pi / 6 * 1e-3;
  EXPECT_NEAR(deepest, std::cbrt(1.5 * m / (pi * 0.05 * 1e10)), 1e-3 * deepest);
  EXPECT_NEAR(s.frame().velocity[0].z, 1, 1e-4);
  LedgerRow const ledger = s.ledger();
  EXPECT_LT(std::abs(ledger.residual), 1e-4 * ledger.moved);
}

// Balls that come, touch and part again in one pair list: what is left of a contact that ended must be nothing.
TEST(SpherePhysics, APairThatPartsLeavesNothingBehind) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.4;
  c.contact[0].damping_ratio = 0.1;
  GrainsCase low = grains_at("sphere", {{0, 0, 0.0501}}), high = grains_at("sphere", {{0.02, 0.01, 0.1505}});
  low.insert.velocity = {0.3, 0, -0.4}, high.insert.velocity = {-0.2, 0.1, -0.8};
  high.name = "high";
  c.grains = {low, high};
  c.wall = {floor_at(0)};
  c.time.end = 0.05;
  Simulation s(c, {});
  int parted = 0, met = 0;
  std::vector<char> before;
  while (s.step() == RunState::running) {
    Workspace const& work = s.impl().work;
    State const& state = s.impl().state;
    for (std::size_t k = 0; k < work.pair.size(); ++k) {
      Pair const p = work.pair[k];
      double const gap =
          p.with_plane() ? state.position[p.a].z - 0.05 : norm(state.position[p.a] - state.position[p.b]) - 0.1;
      PairResult const& r = work.result[k];
      EXPECT_EQ(work.in_contact[k] != 0, gap < 0);
      EXPECT_NEAR(r.overlap, std::max(0.0, -gap), 1e-15);
      EXPECT_EQ(r.active, gap < 0 ? 1 : 0);
      EXPECT_EQ(norm(r.elastic.force_on_a) > 0, gap < 0);
      if (gap >= 0) {
        EXPECT_EQ(norm(r.friction.force_on_a) + norm(r.friction.torque_a) + norm(r.damping.force_on_a) + r.stiffness +
                      r.energy_normal + r.energy_tangential + r.friction_loss,
                  0);
      }
      if (before.size() == work.in_contact.size()) parted += before[k] && !work.in_contact[k], met += gap < 0;
    }
    before = work.in_contact;
  }
  EXPECT_GE(parted, 2);
  EXPECT_GT(met, 20);
}

// A ball that is nowhere touches nobody: its neighbour stays a number, and the message names the one that is lost.
TEST(SpherePhysics, WhatIsNoNumberTouchesNothing) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0, 0, 0}, {0, 0, 0.099}})};
  c.time.end = 0.01;
  Simulation s(c, {});
  s.impl().state.position[1].x = std::numeric_limits<double>::quiet_NaN();
  try {
    s.step();
    FAIL() << "nobody noticed";
  } catch (WatchStop const& stop) {
    EXPECT_NE(std::string(stop.what()).find("grain 1 "), std::string::npos) << stop.what();
  }
  EXPECT_TRUE(is_finite(s.impl().state.velocity[0]));
}

TEST(SpherePhysics, SizesAreDrawnUniformly) {
  Case c = rock_case();
  GrainsCase g = grains_at("sphere", {});
  for (int i = 0; i < 2000; ++i) g.insert.position.push_back({0.5 * i, 0, 0});
  g.count = 2000;
  g.diameter = 0.2, g.least_diameter = 0.1;
  c.grains = {g};
  Simulation s(c, {}), again(c, {});
  std::vector<double> const& d = s.impl().scene.diameter;
  EXPECT_EQ(d, again.impl().scene.diameter);
  double sum = 0, square = 0;
  for (int i = 0; i < 2000; ++i) {
    EXPECT_TRUE(d[i] >= 0.1 && d[i] <= 0.2);
    EXPECT_NEAR(s.impl().scene.mass[i] / (2650 * std::numbers::pi / 6 * d[i] * d[i] * d[i]), 1, 1e-12);
    sum += d[i], square += d[i] * d[i];
  }
  double const mean = sum / 2000, variance = square / 2000 - mean * mean;
  EXPECT_NEAR(mean, 0.15, 4 * 0.1 / std::sqrt(12 * 2000.0));  // four standard errors
  EXPECT_NEAR(variance / (0.01 / 12), 1, 0.1);
}

TEST(SpherePhysics, EmptyAndSingleAndFarAwayScenesRun) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.wall = {floor_at(0)};
  c.time.end = 0.01;
  EXPECT_EQ(Simulation(c, {}).bodies(), 0);
  c.grains = {grains_at("sphere", {{1e3, -1e3, 50}})};
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  EXPECT_EQ(s.state(), RunState::ended);
  EXPECT_NEAR(s.frame().velocity[0].z, -9.81 * s.time(), 1e-9);
}

TEST(SpherePhysics, WatchStopsARunawayOverlapAndNamesTheGrain) {
  Case c = rock_case();
  c.limits.overlap = 0.01;
  GrainsCase g = grains_at("sphere", {{0, 0, 0.051}});
  g.insert.velocity = {0, 0, -30};
  c.grains = {g};
  c.wall = {floor_at(0)};
  Simulation s(c, {});
  try {
    while (s.step() == RunState::running) {
    }
    FAIL() << "the watch let an overlap beyond 0.01 d pass";
  } catch (WatchStop const& stop) {
    std::string const text = stop.what();
    EXPECT_NE(text.find("grain 0 (sphere)"), std::string::npos) << text;
    EXPECT_NE(text.find("wall 'floor'"), std::string::npos) << text;
  }
}

TEST(SpherePhysics, AFixedStepBeyondCriticalIsRefused) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.grains = {grains_at("sphere", {{0, 0, 0.06}})};
  c.wall = {floor_at(0)};
  c.time.step = 2e-3;
  Simulation s(c, {});
  EXPECT_THROW(
      {
        while (s.step() == RunState::running) {
        }
      },
      WatchStop);
}

}  // namespace
}  // namespace scree
