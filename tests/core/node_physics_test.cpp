// node_physics_test.cpp: contacts through surface nodes: lists against brute force, threads, starts, meters, plans.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/support/contact_sets.h"

namespace scree {
namespace {

using namespace testing;

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

// The meter, where the answer is known: an ellipsoid that hovers over a floor asks for all of its nodes at every step
// of a brute force, and for none of them by its list.
TEST(NodePhysics, QueriesAreCounted) {
  Case c = rock_case();
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 0.0405}}, 0.1, 250)};
  c.wall = {floor_at(0)};
  c.time.end = 0.01;
  Simulation brute(c, {.brute_force = true}), lists(c, {});
  for (int k = 0; k < 20; ++k) brute.step(), lists.step();
  std::int64_t const nodes = 20 * brute.impl().scene.shape[0].nodes;
  for (Simulation const* s : {&brute, &lists}) EXPECT_EQ(s->query_counts().nodes, nodes);
  EXPECT_EQ(brute.query_counts().listed, nodes);
  EXPECT_EQ(brute.query_counts().due, nodes);
  EXPECT_EQ(lists.query_counts().made(), 0);  // what it was asked at the start does not count
  EXPECT_EQ(lists.query_counts().flop, 0);    // nobody has a network
}

// Two networks face each other, apart: every query is one evaluation without a gradient, 2 operations a weight.
TEST(NodePhysics, OperationsOfNetworksAreCounted) {
  Case c = rock_case();
  c.library = {{"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  c.grains = {grains_at("grains:ellipsoid/3", {{0, 0, 0}, {0, 0, 1}}, 0.1, 250)};
  Box const box = Simulation(c, {}).impl().scene.shape[0].box;
  c.grains[0].insert.position[1].z = 0.1 * (box.max.z - box.min.z + 0.02);
  c.time.end = 0.01;
  Simulation s(c, {.brute_force = true});
  for (int k = 0; k < 5; ++k) s.step();
  QueryCounts const counts = s.query_counts();
  EXPECT_EQ(counts.due, 5 * 2 * s.impl().scene.shape[0].nodes);
  EXPECT_GT(counts.blocks, 0);
  EXPECT_EQ(counts.again, 0);
  std::vector<int> const& width = s.impl().scene.networks.net.at(0).net().width;
  double flop = 2.0 * 3 * width[1];
  for (std::size_t l = 1; l + 1 < width.size(); ++l) flop += 2.0 * width[l] * width[l + 1];
  EXPECT_EQ(counts.flop, flop * static_cast<double>(counts.due + counts.blocks));
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

// A skin decides how often lists are made anew and how long they are, and nothing else.
TEST(NodePhysics, SkinsDoNotChangeTheBits) {
  Case const c = heap();
  Simulation thin(c, {.skin_steps = 2}), usual(c, {}), thick(c, {.skin_steps = 400});
  for (Simulation* s : {&thin, &usual, &thick})
    while (s->step() == RunState::running) {
    }
  for (Simulation* s : {&thin, &thick}) {
    EXPECT_EQ(s->frame().position, usual.frame().position);
    EXPECT_EQ(s->frame().orientation, usual.frame().orientation);
    EXPECT_EQ(s->frame().velocity, usual.frame().velocity);
  }
  auto const rebuilt = [](Simulation& s) { return s.impl().work.gather.lists.rebuilt; };
  EXPECT_GT(rebuilt(thin), 2 * rebuilt(usual));
  EXPECT_LT(rebuilt(thick), rebuilt(usual));
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
