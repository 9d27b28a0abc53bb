// deletion_test.cpp: grains that leave at a boundary: when, with which energy, and what stays behind.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = 3.141592653589793, g = 9.81;
double const mass = 2650 * pi / 6 * 1e-3;  // of a sphere of 0.1 m

void run(Simulation& s) {
  while (s.step() == RunState::running) {
  }
}

int count(Simulation const& s, Activity a) {
  Frame const f = s.frame();
  return static_cast<int>(std::count(f.activity.begin(), f.activity.end(), a));
}

DeleteCase below(double z) {
  DeleteCase d;
  d.name = "below";
  d.plane = true;
  d.point = {0, 0, z};
  return d;
}

// From height h a grain leaves when it has fallen h, with all of its m g h.
TEST(Deletion, AFallThroughAPlaneEndsOnTimeWithItsWholeEnergy) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -g};
  c.grains = {grains_at("sphere", {{0, 0, 1}, {1, 0, 0.5}, {2, 0, 40}})};
  c.deletion = {below(0)};
  c.time.step = 1e-3;
  c.time.end = 1;
  Simulation s(c, {});
  double left[2] = {-1, -1};
  while (s.step() == RunState::running) {
    Frame const f = s.frame();
    for (int i = 0; i < 2; ++i)
      if (left[i] < 0 && f.activity[i] == Activity::deleted) left[i] = s.time();
  }
  EXPECT_NEAR(left[0], std::sqrt(2 * 1 / g), 1e-3);  // one step
  EXPECT_NEAR(left[1], std::sqrt(2 * 0.5 / g), 1e-3);
  EXPECT_EQ(s.frame().activity[2], Activity::active);
  double const energy = mass * g * 1.5;
  EXPECT_NEAR(s.ledger().deleted, energy, 1e-12 * energy);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-12 * energy * 40);
  EXPECT_EQ(s.frame().velocity[0], (Vec3{}));
  EXPECT_TRUE(is_finite(s.frame().position[0]));
}

TEST(Deletion, BoxesTakeTheirInsideOrTheirOutside) {
  for (bool inside : {false, true}) {
    Case c = rock_case();
    c.grains = {grains_at("sphere", {{0, 0, 0}, {0.5, 0.2, -0.3}, {2, 0, 0}, {0, 0, -1.5}})};
    DeleteCase box;
    box.name = "box";
    box.inside = inside;
    box.min = {-1, -1, -1}, box.max = {1, 1, 1};
    c.deletion = {box};
    c.time.end = 0.01;
    Simulation s(c, {});
    run(s);
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(s.frame().activity[i], (i < 2) == inside ? Activity::deleted : Activity::active) << i;
    std::string told;
    for (std::string const& m : s.messages()) told += m;
    EXPECT_NE(told.find("delete 'box': 2 grains left"), std::string::npos) << told;
  }
}

// A grain that is pressed against another leaves: its contact's elastic energy goes with it and the other one, freed of
// the force, keeps the velocity it has.
TEST(Deletion, AContactThatLeavesTakesItsElasticEnergyAlong) {
  Case c = rock_case();
  GrainsCase a = grains_at("sphere", {{0.004, 0, 0}}), b = grains_at("sphere", {{0.1045, 0, 0}});
  b.name = "other";
  a.insert.velocity = {1, 0, 0}, b.insert.velocity = {-1, 0, 0};
  c.grains = {a, b};
  DeleteCase trap;
  trap.name = "trap";
  trap.inside = true;
  trap.min = {0.0045, -1, -1}, trap.max = {0.05, 1, 1};  // the first enters it after 0.5 mm, in contact
  c.deletion = {trap};
  c.time.end = 0.002;
  c.time.safety = 0.02;
  Simulation s(c, {});
  double deepest = 0;
  Vec3 freed{-9, 0, 0};
  while (s.step() == RunState::running) {
    deepest = std::max(deepest, s.largest_overlap());
    if (freed.x == -9 && count(s, Activity::deleted) == 1) {
      freed = s.frame().velocity[1];
      LedgerRow const row = s.ledger();
      EXPECT_EQ(row.elastic_normal, 0);
      EXPECT_GT(row.deleted, 0.5 * mass * norm2(freed));  // as fast as the other, by symmetry, and the elastic energy
    }
  }
  EXPECT_GT(deepest, 0);
  EXPECT_GT(freed.x, -1);
  EXPECT_LT(freed.x, 0);
  EXPECT_EQ(s.frame().velocity[1], freed);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-4 * s.ledger().moved);
}

Case draining(char const* shape) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -g};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.3;
  GrainsCase grains = grains_at(shape, {});
  grains.nodes = 250;
  grains.count = 16;
  grains.insert.kind = InsertCase::Kind::rate;
  grains.insert.rate = 80;
  grains.insert.box = {{-0.15, -0.15, 0.3}, {0.15, 0.15, 0.6}};
  grains.insert.orientation = Orientation::random;
  grains.insert.velocity = {0, 0, -1};
  c.grains = {grains};
  WallCase slope = floor_at(0);
  slope.normal = {0.5, 0, 1};  // grains slide to +x
  c.wall = {slope};
  DeleteCase edge;
  edge.name = "edge";
  edge.plane = true;
  edge.point = {0.25, 0, 0};
  edge.normal = {-1, 0, 0};
  c.deletion = {edge};
  c.time.end = 0.6;
  return c;
}

// Grains come, collide, slide and leave while they touch; the ledger names all of it.
TEST(Deletion, LedgerClosesWhileGrainsComeAndGo) {
  for (char const* shape : {"sphere", "ellipsoid:1:0.8:0.6"}) {
    Simulation s(draining(shape), {});
    run(s);
    LedgerRow const row = s.ledger();
    EXPECT_GE(count(s, Activity::deleted), 4) << shape;
    EXPECT_GE(count(s, Activity::active), 1) << shape;
    EXPECT_GT(row.friction, 0);
    EXPECT_LT(std::abs(row.residual), 1e-3 * row.moved) << shape;
    EXPECT_EQ(s.results_header().ledger, (std::vector<std::string>{"inserted", "deleted"}));
  }
}

TEST(Deletion, LedgerClosesWithRollingResistance) {
  Case c = draining("sphere");
  c.contact[0].rolling = RollingCase{0.1};
  Simulation s(c, {});
  run(s);
  EXPECT_GE(count(s, Activity::deleted), 4);
  EXPECT_GT(s.ledger().rolling, 0);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved);
}

TEST(Deletion, TheSameBitsForAnyThreads) {
  SimulationOptions two;
  two.threads = 2;
  Simulation a(draining("sphere"), {}), b(draining("sphere"), two);
  run(a), run(b);
  EXPECT_EQ(a.frame().position, b.frame().position);
  EXPECT_EQ(a.frame().activity, b.frame().activity);
  EXPECT_EQ(a.ledger().residual, b.ledger().residual);
}

// Without the key nothing of it exists; with a region that nobody reaches the grains move as without.
TEST(Deletion, PlanAndBitsOff) {
  Case plain = rock_case();
  plain.gravity = Vec3{0, 0, -g};
  plain.contact[0].friction = 0.5;
  plain.grains = {grains_at("sphere", {{0, 0, 0.06}, {0.11, 0, 0.06}})};
  plain.grains[0].insert.velocity = {0.5, 0, -1};
  plain.wall = {floor_at(0)};
  plain.time.end = 0.05;
  Case with = plain;
  with.deletion = {below(-5)};
  Simulation a(plain, {}), b(with, {});
  std::vector<std::string> stages = a.plan().stages;
  EXPECT_EQ(std::count(stages.begin(), stages.end(), "delete"), 0);
  EXPECT_TRUE(a.frame().activity.empty());
  EXPECT_FALSE(a.results_header().activity);
  for (Plan::Array const& array : a.plan().arrays) EXPECT_NE(array.name, "activity");
  stages.insert(stages.end() - 1, "delete");
  EXPECT_EQ(b.plan().stages, stages);
  run(a), run(b);
  EXPECT_EQ(a.frame().position, b.frame().position);
  EXPECT_EQ(a.frame().spin, b.frame().spin);
  EXPECT_EQ(a.ledger().residual, b.ledger().residual);
  EXPECT_EQ(b.ledger().deleted, 0);
}

}  // namespace
}  // namespace scree
