// zero_strength_test.cpp: an effect keyed to zero strength, or absent, is the plain scene: launches, bytes and bits.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/effects.h"
#include "core/simulation_impl.h"
#include "tests/support/measures.h"
#include "tests/support/same_state.h"

namespace scree {
namespace {

using namespace testing;

// Closed-form spheres and node contacts under gravity, with nothing else: sliding, spinning, bouncing on a floor, one
// another and a cylinder.
Case bouncing() {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].stiffness = 1e5;
  GrainsCase balls = grains_at("sphere", {{0, 0, 0.06}, {0.11, 0, 0.06}});
  GrainsCase eggs = grains_at("ellipsoid:1:0.8:0.6", {{0.05, 0.11, 0.055}, {0.05, 0.01, 0.14}}, 0.1, 250);
  eggs.name = "egg";
  balls.insert.velocity = eggs.insert.velocity = {0.5, 0, -1};
  eggs.insert.spin = {5, 3, 0};
  c.grains = {balls, eggs};
  WallCase pole = floor_at(0);
  pole.name = "pole";
  pole.kind = WallKind::cylinder;
  pole.inside = false;
  pole.from = {0.245, 0.05, 0}, pole.to = {0.245, 0.05, 1};
  pole.radius = 0.08;
  c.wall = {floor_at(0), pole};
  c.time.end = 0.03;
  return c;
}

void damp(Case& c, double ratio) { c.contact[0].damping_ratio = ratio; }

MotionCase turning(double rate) {
  MotionCase m;
  m.rate = rate;
  m.through = {0.245, 0.05, 0};
  return m;
}

MotionCase sliding(Vec3 velocity) {
  MotionCase m;
  m.kind = MotionKind::translation;
  m.velocity = velocity;
  return m;
}

MotionCase tabled(double rate) {
  MotionCase m = turning(0);
  m.time = {0, 0.05};
  m.rates = {0, rate};
  return m;
}

ForceCase pushing(Vec3 force, TimeTable const& table = {}) { return {"push", "egg", force, {}, 0, {}, table}; }

// Grains that would come later, where the others never are.
void pour(Case& c, int count) {
  GrainsCase g = grains_at("sphere", {});
  g.name = "late";
  g.count = count;
  g.insert.kind = InsertCase::Kind::rate;
  g.insert.rate = 100;
  g.insert.box = {{-1, -1, 1}, {-0.5, -0.5, 1.5}};
  c.grains.push_back(g);
}

// One way to write an effect, in words; at zero strength, and at a strength at which it must be seen.
struct Keyed {
  char const* name;
  std::function<void(Case&)> zero, strong;
};

std::vector<Keyed> const keyed{
    {"friction", [](Case& c) { c.contact[0].friction = 0; }, [](Case& c) { c.contact[0].friction = 0.3; }},
    {"damping.ratio", [](Case& c) { damp(c, 0); }, [](Case& c) { damp(c, 0.3); }},
    {"damping.restitution", [](Case& c) { c.contact[0].restitution = 1; },
     [](Case& c) { c.contact[0].restitution = 0.5; }},
    {"rolling",
     [](Case& c) {
       c.contact[0].rolling = RollingCase{0, 2.25, 0.3};
     },
     [](Case& c) {
       c.contact[0].rolling = RollingCase{0.3, 2.25, 0.3};
     }},
    {"cohesion without traction",
     [](Case& c) {
       c.contact[0].cohesion = CohesionCase{0, 1e-3};
     },
     [](Case& c) {
       c.contact[0].cohesion = CohesionCase{1e4, 1e-3};
     }},
    {"cohesion without range",
     [](Case& c) {
       c.contact[0].cohesion = CohesionCase{1e4, 0};
     },
     [](Case& c) {
       c.contact[0].cohesion = CohesionCase{1e4, 1e-3};
     }},
    {"gravity", [](Case& c) { c.gravity = Vec3{}; },
     [](Case& c) {
       c.gravity = Vec3{0, 0, -9.81};
     }},
    {"drag without coefficient",
     [](Case& c) {
       c.drag = DragCase{1.2, 0, {50, 0, 0}};
     },
     [](Case& c) {
       c.drag = DragCase{1.2, 0.5, {50, 0, 0}};
     }},
    {"drag in a vacuum",
     [](Case& c) {
       c.drag = DragCase{0, 0.5, {50, 0, 0}};
     },
     [](Case& c) {
       c.drag = DragCase{1.2, 0.5, {50, 0, 0}};
     }},
    {"global damping", [](Case& c) { c.damping = DampingCase{0}; }, [](Case& c) { c.damping = DampingCase{1}; }},
    {"force", [](Case& c) { c.force = {pushing({})}; },
     [](Case& c) {
       c.force = {pushing({5, 0, 0})};
     }},
    {"force by table",
     [](Case& c) {
       c.force = {pushing({5, 0, 0}, {{0, 0.1}, {0, 0}})};
     },
     [](Case& c) {
       c.force = {pushing({5, 0, 0}, {{0, 0.1}, {0, 1}})};
     }},
    {"insertion", [](Case& c) { pour(c, 0); }, [](Case& c) { pour(c, 3); }},
    {"rotation", [](Case& c) { c.wall[1].motion = turning(0); }, [](Case& c) { c.wall[1].motion = turning(3); }},
    {"translation of a plane", [](Case& c) { c.wall[0].motion = sliding({}); },
     [](Case& c) {
       c.wall[0].motion = sliding({0, 0, 0.1});
     }},
    {"rotation by table", [](Case& c) { c.wall[1].motion = tabled(0); }, [](Case& c) { c.wall[1].motion = tabled(3); }},
};

struct Outcome {
  Plan plan;
  std::vector<std::string> launches;  // "stage/what calls items"
  State state;
  LedgerRow ledger;
  std::vector<std::string> columns;
};

Outcome run(Case const& c) {
  Simulation s(c, {});
  Outcome out{s.plan(), {}, {}, {}, s.results_header().ledger};
  while (s.step() == RunState::running) {
  }
  for (Profile::Entry const& e : s.profile().entries())
    out.launches.push_back(e.name + " " + std::to_string(e.calls) + " " + std::to_string(e.items));
  out.state = s.impl().state;
  out.ledger = s.ledger();
  return out;
}

std::vector<std::string> arrays(Plan const& p) {
  std::vector<std::string> out;
  for (Plan::Array const& a : p.arrays) out.push_back(a.name + " " + std::to_string(a.bytes));
  return out;
}

void expect_same(Outcome const& plain, Outcome const& other) {
  EXPECT_EQ(plain.launches, other.launches);
  EXPECT_EQ(plain.plan.stages, other.plan.stages);
  EXPECT_EQ(plain.plan.effects, other.plan.effects);
  EXPECT_EQ(plain.plan.law, other.plan.law);
  EXPECT_EQ(plain.plan.step, other.plan.step);
  EXPECT_EQ(arrays(plain.plan), arrays(other.plan));
  EXPECT_EQ(differences(plain.state, other.state), "");
  EXPECT_EQ(std::memcmp(&plain.ledger, &other.ledger, sizeof(LedgerRow)), 0);
  EXPECT_EQ(plain.columns, other.columns);
}

TEST(ZeroStrength, IsThePlainScene) {
  Outcome const with_gravity = run(bouncing());
  Case weightless = bouncing();
  weightless.gravity.reset();
  Outcome const without = run(weightless);
  ASSERT_NE(with_gravity.ledger.elastic_normal + with_gravity.ledger.kinetic, 0);
  for (Keyed const& k : keyed) {
    SCOPED_TRACE(k.name);
    bool const gravity = k.name == std::string("gravity");
    Case const plain = gravity ? weightless : bouncing();
    Case zero = plain, strong = plain;
    k.zero(zero);
    k.strong(strong);
    Outcome const& expected = gravity ? without : with_gravity;
    expect_same(expected, run(zero));
    // Or the comparison would say nothing.
    Outcome const seen = run(strong);
    EXPECT_NE(differences(expected.state, seen.state), "");
    EXPECT_NE(expected.plan.effects.size() + expected.plan.stages.size(),
              seen.plan.effects.size() + seen.plan.stages.size());
  }
}

// Effects that have no strength: without their key they are absent.
TEST(ZeroStrength, NothingThatHasNoKeyIsThere) {
  Simulation s(bouncing(), {});
  Effects const& e = s.impl().effects;
  EXPECT_FALSE(e.deletion || e.measures || e.settle || e.settle_damping || e.insertion || e.wall_motion);
  for (std::string const& stage : s.plan().stages)
    EXPECT_TRUE(stage != "delete" && stage != "measure" && stage != "global_damping" && stage != "insertion") << stage;
  State const& state = s.impl().state;
  EXPECT_TRUE(state.activity.empty() && state.insertion.empty() && state.deleted.empty() && state.measure.empty());
  EXPECT_TRUE(state.node_history.xi.empty() && state.sphere_history.xi.empty() && state.rolling_history.angle.empty());
  EXPECT_TRUE(state.work_applied.empty() && state.removed_by_drag.empty() && state.work_rolling.empty());
}

// The settle schedule without damping only watches: not a launch, not a bit of the motion.
TEST(ZeroStrength, SettleWithoutDampingOnlyWatches) {
  Case watched = bouncing(), damped = bouncing();
  watched.time.settle = SettleCase{0, 0, 1e-8, 0.2};
  damped.time.settle = SettleCase{5, 0, 1e-8, 0.2};
  Outcome const plain = run(bouncing()), a = run(watched), b = run(damped);
  EXPECT_EQ(plain.launches, a.launches);
  EXPECT_EQ(plain.plan.stages, a.plan.stages);
  EXPECT_EQ(differences(plain.state, a.state), "damped ");  // what the schedule remembers
  EXPECT_EQ(std::memcmp(&plain.ledger, &a.ledger, sizeof(LedgerRow)), 0);
  EXPECT_EQ(plain.columns, a.columns);
  EXPECT_NE(plain.launches, b.launches);
  EXPECT_NE(plain.state.position, b.state.position);
}

}  // namespace
}  // namespace scree
