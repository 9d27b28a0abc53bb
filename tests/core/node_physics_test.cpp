// node_physics_test.cpp: contacts through surface nodes: restitution, blocks that hold or slide, collisions, meters.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "core/simulation_impl.h"
#include "kernels/restitution.h"
#include "tests/support/cases.h"
#include "tests/support/contact_sets.h"

namespace scree {
namespace {

using namespace testing;

double const pi = 3.141592653589793;

// Rebound of a body dropped with `speed` on a plane along one of its axes, per unit speed.
double rebound(std::string const& shape, double reach, double zeta, double speed, int nodes) {
  Case c = rock_case();
  c.contact[0].damping_ratio = zeta;
  GrainsCase g = grains_at(shape, {{0, 0, reach * 0.1 + 1e-4}}, 0.1, nodes);
  g.insert.velocity = {0, 0, -speed};
  c.grains = {g};
  c.wall = {floor_at(0)};
  c.time.end = 1;
  c.time.safety = 0.1;
  Simulation s(c, {});
  bool touched = false;
  while (s.step() == RunState::running) {
    touched = touched || s.largest_overlap() > 0;
    if (touched && s.largest_overlap() == 0) break;
  }
  return s.frame().velocity[0].z / speed;
}

// Validation row 7a: e(zeta) at three speeds, three node counts, and for a 5:1 body, to 2 % (of full speed at small e).
TEST(NodePhysics, RestitutionDependsOnTheDampingRatioAlone) {
  double const long_axis = 0.5 * std::cbrt(25.0);  // of ellipsoid 5:1:1 with volume pi/6, in d
  for (double zeta : {0.1, 0.4, 0.7, 1.0}) {
    double const e = restitution_of(zeta, DampingPath::nodes);
    for (double speed : {0.3, 1.0, 3.0})
      EXPECT_NEAR(rebound("ellipsoid:1:1:1", 0.5, zeta, speed, 1000), e, 0.02) << zeta << " at " << speed << " m/s";
    for (int nodes : {250, 4000})
      EXPECT_NEAR(rebound("ellipsoid:1:1:1", 0.5, zeta, 3, nodes), e, 0.02) << zeta << ", " << nodes << " nodes";
    EXPECT_NEAR(rebound("ellipsoid:1:1:5", long_axis, zeta, 1, 1000), e, 0.02) << zeta << ", on its tip";
    EXPECT_NEAR(rebound("ellipsoid:5:1:1", long_axis / 5, zeta, 1, 1000), e, 0.02) << zeta << ", on its flank";
  }
}

// Validation row 7: a block on an incline holds at friction 2 % above tan(theta) and slides with
// a = g (sin - mu cos) at 2 % below.
TEST(NodePhysics, BlockOnAnInclineHoldsOrSlides) {
  double const theta = 0.4, g = 9.81, d = 0.1;
  for (double factor : {1.02, 0.98}) {
    double const mu = factor * std::tan(theta);
    Case c = rock_case();
    c.gravity = Vec3{g * std::sin(theta), 0, -g * std::cos(theta)};
    c.contact[0].friction = mu;
    c.contact[0].damping_ratio = 0.7;
    double const half_height = 0.5 * d * std::cbrt(pi / 6 / 4);  // box 2:2:1 of volume pi/6 d^3
    c.grains = {grains_at("box:2:2:1", {{0, 0, half_height - 1e-6}}, d, 1000)};
    c.wall = {floor_at(0)};
    c.time.end = 0.4;
    // The load comes on at once and only 4e-4 J move: 0.3 of the critical step leaves 1.03e-3 of that open, and the
    // remainder falls with the square of the step.
    c.time.safety = 0.2;
    Simulation s(c, {});
    double x_before = 0, t_before = 0, v_before = 0;
    while (s.step() == RunState::running)
      if (t_before == 0 && s.time() > 0.25)
        x_before = s.frame().position[0].x, t_before = s.time(), v_before = s.frame().velocity[0].x;
    double const span = s.time() - t_before;
    if (factor > 1) {
      EXPECT_LT(std::abs(s.frame().position[0].x - x_before) / span, 1e-6 * d);
    } else {
      double const a = g * (std::sin(theta) - mu * std::cos(theta));
      EXPECT_NEAR((s.frame().velocity[0].x - v_before) / span / a, 1, 1e-3);
    }
    EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved);
  }
}

// Validation row 7c: an oblique impact in full sliding takes the tangential impulse mu (1 + e) m v_n.
TEST(NodePhysics, SlidingImpactTakesTheCoulombImpulse) {
  double const mu = 0.1, vn = 1, vt = 3;
  Case c = rock_case();
  c.contact[0].friction = mu;
  c.contact[0].damping_ratio = 0.7;
  GrainsCase g = grains_at("ellipsoid:1:1:1", {{0, 0, 0.0501}}, 0.1, 4000);
  g.insert.velocity = {vt, 0, -vn};
  c.grains = {g};
  c.wall = {floor_at(0)};
  c.time.end = 0.02;
  c.time.safety = 0.05;
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  double const e = s.frame().velocity[0].z / vn;
  EXPECT_NEAR((vt - s.frame().velocity[0].x) / (mu * (1 + e) * vn), 1, 5e-3);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved);
}

Case heap() {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.7;
  GrainsCase g = grains_at("ellipsoid:1:0.8:0.6", {}, 0.1, 250);
  g.shapes = {"ellipsoid:1:0.8:0.6", "ellipsoid:1:1:0.5", "sphere"};
  g.count = 8;
  g.insert.kind = InsertCase::Kind::lattice;
  g.insert.orientation = Orientation::random;
  g.insert.velocity = {0.8, 0.4, -4};
  g.insert.box = {{0, 0, 0}, {0.28, 0.28, 1.2}};
  c.grains = {g};
  c.wall = {open_box({0, 0, 0}, {0.28, 0.28, 2})};
  c.time.end = 0.03;
  return c;
}

TEST(NodePhysics, NodeListsGiveTheContactSetsOfBruteForce) {
  Case const c = heap();
  Simulation lists(c, {}), brute(c, {.threads = 2, .brute_force = true});
  expect_same_contact_sets(lists, brute, 1000);
  EXPECT_LT(lists.impl().work.active.queries, brute.impl().work.active.queries / 20);
}

// The same for the shipped networks, whose Lipschitz bound is sampled, not proved.
TEST(NodePhysics, NodeListsOfNetworksGiveTheContactSetsOfBruteForce) {
  Case c = heap();
  c.library = {{"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  c.grains[0].shapes = {"grains:ballast/0", "grains:sand/4", "grains:cobble/1", "grains:ellipsoid/3"};
  c.grains[0].insert.box = {{0, 0, 0}, {0.34, 0.34, 1.2}};
  c.wall = {open_box({0, 0, 0}, {0.34, 0.34, 2})};
  c.time.end = 0.04;
  Simulation lists(c, {.threads = 2}), brute(c, {.threads = 2, .brute_force = true});
  expect_same_contact_sets(lists, brute, 1000);
}

// The same for nodes kept as 16-bit radii; sand/4 is not star-shaped and keeps arrays, so both storages meet.
TEST(NodePhysics, NodeListsOfCompactGrainsGiveTheContactSetsOfBruteForce) {
  Case c = heap();
  c.library = {{"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  c.grains[0].shapes = {"grains:ballast/0", "grains:sand/4", "grains:cobble/1", "grains:ellipsoid/3"};
  c.grains[0].storage = NodeStorage::compact;
  c.grains[0].nodes = 150;
  c.grains[0].insert.box = {{0, 0, 0}, {0.34, 0.34, 1.2}};
  c.wall = {open_box({0, 0, 0}, {0.34, 0.34, 2})};
  Simulation lists(c, {.threads = 1}), brute(c, {.threads = 2, .brute_force = true});
  ASSERT_EQ(lists.impl().scene.compact.record.size(), 3u);
  expect_same_contact_sets(lists, brute, 500);
  EXPECT_EQ(lists.ledger().residual, brute.ledger().residual);
}

TEST(NodePhysics, ThreadsDoNotChangeTheBits) {
  Case const c = heap();
  Simulation one(c, {.threads = 1}), two(c, {.threads = 2}), four(c, {.threads = 4});
  while (one.state() == RunState::running)
    for (Simulation* s : {&one, &two, &four}) s->step();
  EXPECT_EQ(one.frame().position, two.frame().position);
  EXPECT_EQ(one.frame().orientation, two.frame().orientation);
  EXPECT_EQ(one.frame().position, four.frame().position);
  EXPECT_EQ(one.ledger().residual, two.ledger().residual);
  EXPECT_LT(std::abs(one.ledger().residual), 1e-3 * one.ledger().moved);
}

TEST(NodePhysics, ARunStartsFromAnyFrame) {
  Case const c = heap();
  Simulation whole(c, {});
  for (int k = 0; k < 20; ++k) whole.step();
  Frame const frame = whole.frame();
  Simulation again(c, {}, frame);
  EXPECT_EQ(again.time_step(), whole.time_step());
  EXPECT_EQ(again.time(), 0);
  EXPECT_EQ(again.frame().position, frame.position);
  EXPECT_EQ(again.frame().velocity, frame.velocity);
  for (std::size_t i = 0; i < frame.spin.size(); ++i)  // through the angular momentum and back
    EXPECT_LT(norm(again.frame().spin[i] - frame.spin[i]), 1e-12 * (1 + norm(frame.spin[i])));
  Frame other = frame;
  other.position.pop_back();
  EXPECT_THROW(Simulation(c, {}, other), InputError);
}

TEST(NodePhysics, FrictionLossMeasuredAtTheNodesAgreesWithTheLedger) {
  Case const c = heap();
  Simulation s(c, {});
  double lost = 0;
  while (s.step() == RunState::running)
    for (PairResult const& r : s.impl().work.result) lost += r.friction_loss;
  EXPECT_GT(lost, 0.01 * s.ledger().moved);
  // Work over a step is taken at two velocities half a step apart.
  EXPECT_NEAR(lost, s.ledger().friction, 0.02 * s.ledger().moved);
}

TEST(NodePhysics, PlansHoldWhatTheSceneNeeds) {
  Case c = rock_case();
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 1}})};
  c.wall = {floor_at(0)};
  EXPECT_EQ(Simulation(c, {}).plan().stages,
            (std::vector<std::string>{"bounds", "broad_phase", "node_gather", "sdf_analytic", "contact_reduce",
                                      "integrate", "watch"}));
  auto const has_history = [](Plan const& plan) {
    for (auto const& array : plan.arrays)
      if (array.name == "contact history") return true;
    return false;
  };
  EXPECT_FALSE(has_history(Simulation(c, {}).plan()));
  c.contact[0].friction = 0.3;
  EXPECT_TRUE(has_history(Simulation(c, {}).plan()));
}

}  // namespace
}  // namespace scree
