// insertion_test.cpp: grains at random places, by rate and from tables; inactive bodies take no part in anything.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/grain_rays.h"
#include "core/overlap_meter.h"
#include "core/simulation_impl.h"
#include "core/surface_export.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
using Kind = InsertCase::Kind;
double constexpr pi = 3.141592653589793;
double const mass = 2650 * pi / 6 * 1e-3;  // of a sphere of 0.1 m

GrainsCase grains_in(Box const& box, int count, Kind kind, std::string const& shape = "sphere") {
  GrainsCase g = grains_at(shape, {});
  g.name = "inserted";
  g.count = count;
  g.insert.kind = kind;
  g.insert.box = box;
  g.insert.rate = 10;
  return g;
}

Case falling_in(int count, double rate) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.3;
  c.grains = {grains_in({{-0.3, -0.3, 0.4}, {0.3, 0.3, 0.8}}, count, Kind::rate)};
  c.grains[0].insert.rate = rate;
  c.grains[0].insert.velocity = {0, 0, -1};
  c.wall = {floor_at(0)};
  c.time.end = 0.5;
  return c;
}

void run(Simulation& s) {
  while (s.step() == RunState::running) {
  }
}

int active(Frame const& f) {
  return static_cast<int>(std::count(f.activity.begin(), f.activity.end(), Activity::active));
}

std::string refusal(Case const& c) {
  try {
    Simulation const s(c, {});
  } catch (InputError const& error) {
    return error.what();
  }
  return "";
}

TEST(RandomInsertion, BoundingSpheresMeetNothing) {
  Case c = rock_case();
  Box const box{{0, 0, 0}, {1, 1, 1}};
  c.grains = {grains_in(box, 60, Kind::random, "ellipsoid:1:0.8:0.6"), grains_at("sphere", {{0.5, 0.5, 0.5}}, 0.3)};
  c.grains[0].nodes = 100;
  WallCase tilted = floor_at(0);
  tilted.normal = {1, 0, 1};
  tilted.point = {0.4, 0, 0};
  c.wall = {tilted};
  Simulation s(c, {});
  Frame const f = s.frame();
  double const r = s.impl().scene.shape[s.impl().scene.shape_of[0]].bounding_radius * 0.1;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(f.position[i][k], r);
      EXPECT_LE(f.position[i][k], 1 - r);
    }
    EXPECT_GE(dot(normalized(tilted.normal), f.position[i] - tilted.point), r);
    EXPECT_GE(norm(f.position[i] - f.position[60]), r + 0.15);
    for (int j = 0; j < i; ++j) EXPECT_GE(norm(f.position[i] - f.position[j]), 2 * r);
  }
  EXPECT_EQ(Simulation(c, {}).frame().position, f.position);
  c.seed = 2;
  EXPECT_NE(Simulation(c, {}).frame().position[0], f.position[0]);
  EXPECT_TRUE(f.activity.empty());  // all are there from the start
  EXPECT_EQ(Simulation(c, {}).results_header().ledger, (std::vector<std::string>{}));
}

// Grains that stick within a range start and enter beyond it: no bond comes from nothing.
TEST(RandomInsertion, PlacesAreOutOfTheReachOfCohesion) {
  Case c = rock_case();
  c.contact[0].cohesion = CohesionCase{1e4, 0.002};  // [Pa], [m]
  c.grains = {grains_in({{0, 0, 0}, {0.45, 0.45, 0.45}}, 15, Kind::random)};
  Simulation s(c, {});
  EXPECT_EQ(s.ledger().elastic_normal, 0);
  Frame const f = s.frame();
  double nearest = 1;
  for (int i = 0; i < 15; ++i)
    for (int j = 0; j < i; ++j) nearest = std::min(nearest, norm(f.position[i] - f.position[j]));
  EXPECT_GE(nearest, 0.1 + 0.002);
}

TEST(RandomInsertion, WhatFindsNoPlaceIsRefusedWithTheReason) {
  Case c = rock_case();
  c.grains = {grains_in({{0, 0, 0}, {0.3, 0.3, 0.3}}, 27, Kind::random)};  // a lattice fills it: 52 % by volume
  std::string const text = refusal(c);
  EXPECT_NE(text.find("grains 'inserted': grain "), std::string::npos) << text;
  EXPECT_NE(text.find("no free place in insert.box"), std::string::npos) << text;
  c.grains = {grains_in({{0, 0, 0}, {1, 1, 0.09}}, 1, Kind::rate)};
  EXPECT_NE(refusal(c).find("even while it is empty"), std::string::npos) << refusal(c);
  c.grains[0].insert.box.max.z = 0.11;
  EXPECT_EQ(refusal(c), "");
}

TEST(FileInsertion, EachGrainHasItsOwnShapeVelocityAndSpin) {
  Case c = rock_case();
  GrainsCase g = grains_at("sphere", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  g.insert.kind = Kind::file;
  g.insert.file = "grains.csv";  // as if it had been read
  g.shapes = {"sphere", "box:1:1:2"};
  g.nodes = 100;
  g.insert.shape = {1, 0, 1};
  g.insert.velocities = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  g.insert.spins = {{4, 0, 0}, {0, 5, 0}, {0, 0, 6}};
  c.grains = {g};
  Simulation s(c, {});
  Frame const f = s.frame();
  EXPECT_EQ(f.velocity, g.insert.velocities);
  for (int i = 0; i < 3; ++i) EXPECT_LT(norm(f.spin[i] - g.insert.spins[i]), 1e-12);
  ResultsHeader const h = s.results_header();
  EXPECT_EQ(h.shape[0], h.shape[2]);
  EXPECT_NE(h.shape[0], h.shape[1]);
  EXPECT_EQ(h.shape_name[h.shape[1]], "sphere");
  c.grains[0].insert.shape[1] = 2;
  EXPECT_NE(refusal(c).find("insert.file asks for shape 2, but `shapes` names 2"), std::string::npos) << refusal(c);
}

// The k-th grain enters at start + k / rate; each brings m v^2 / 2 and the potential energy of its place.
TEST(RateInsertion, KeepsTheClockAndNamesTheEnergy) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.grains = {grains_in({{0, 0, 10}, {2, 2, 12}}, 8, Kind::rate)};
  c.grains[0].insert.start = 0.1;
  c.grains[0].insert.velocity = {0, 0, -1};
  c.time.end = 1.5;
  c.time.step = 1e-3;
  Simulation s(c, {});
  EXPECT_EQ(active(s.frame()), 0);
  EXPECT_EQ(s.ledger().kinetic, 0);
  EXPECT_EQ(s.ledger().potential, 0);
  double energy = 0;
  for (int steps = 1; s.step() == RunState::running; ++steps) {
    Frame const f = s.frame();
    // Entries happen at the beginning of a step; 1e-6 keeps a grain due within rounding of one out of the count.
    double const t = s.time() - 1e-3;
    int const low = std::clamp(static_cast<int>(std::floor((t - 0.1 - 1e-6) * 10)) + 1, 0, 8);
    int const high = std::clamp(static_cast<int>(std::floor((t - 0.1 + 1e-6) * 10)) + 1, 0, 8);
    ASSERT_GE(active(f), low) << "t = " << t;
    ASSERT_LE(active(f), high) << "t = " << t;
    for (Vec3 const& x : f.position) ASSERT_TRUE(is_finite(x));
  }
  // Free fall: each grain's total energy is what it came with.
  Frame const f = s.frame();
  for (int i = 0; i < 8; ++i) energy += 0.5 * mass * norm2(f.velocity[i]) + mass * 9.81 * f.position[i].z;
  EXPECT_NEAR(s.ledger().inserted, energy, 1e-11 * energy);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-11 * energy);
}

TEST(RateInsertion, WaitingBodiesTouchNothing) {
  // Ten grains wait where one flies by: without contact, friction or a change of its path.
  Case c = rock_case();
  GrainsCase flying = grains_at("sphere", {{1, 1, -1}});
  flying.insert.velocity = {0, 0, 4};
  c.grains = {flying, grains_in({{0, 0, 0}, {1, 1, 1}}, 10, Kind::rate)};
  c.grains[1].insert.start = 10;
  c.damping = DampingCase{0.5};
  c.drag = DragCase{1.2, 0.5, {1, 1, 1}};
  c.time.end = 1;
  Case alone = c;
  alone.grains.pop_back();
  Simulation s(c, {}), t(alone, {});
  c.time.step = alone.time.step = 1e-3;
  Simulation a(c, {}), b(alone, {});
  run(a), run(b);
  EXPECT_EQ(a.frame().position[0], b.frame().position[0]);
  EXPECT_EQ(a.frame().velocity[0], b.frame().velocity[0]);
  EXPECT_EQ(a.ledger().drag, b.ledger().drag);
  EXPECT_EQ(a.ledger().kinetic, b.ledger().kinetic);
  EXPECT_EQ(a.frame().velocity[5], (Vec3{}));
  EXPECT_TRUE(a.impl().work.pair.empty());
}

TEST(RateInsertion, LedgerClosesAndEveryGrainArrives) {
  Case c = falling_in(20, 60);
  Simulation s(c, {});
  run(s);
  EXPECT_EQ(active(s.frame()), 20);
  LedgerRow const row = s.ledger();
  EXPECT_GT(row.inserted, 20 * mass * 9.81 * 0.4);
  EXPECT_GT(row.damping, 0);
  EXPECT_LT(std::abs(row.residual), 1e-3 * row.moved);
}

TEST(RateInsertion, TheSameBitsForAnyThreadsAndFromACopyOfTheState) {
  Case c = falling_in(12, 60);
  c.contact[0].friction.reset();  // history follows the pair list, which a State alone does not hold
  SimulationOptions two;
  two.threads = 2;
  Simulation a(c, {}), b(c, two), copy(c, {});
  for (int i = 0; i < 300; ++i) a.step(), b.step();
  copy.impl().state = a.impl().state;
  copy.impl().work.built_position.clear();
  run(a), run(b), run(copy);
  EXPECT_EQ(a.frame().position, b.frame().position);
  EXPECT_EQ(a.frame().position, copy.frame().position);
  EXPECT_EQ(a.ledger().residual, copy.ledger().residual);
}

// A run that starts from a frame goes on with the bodies that frame calls active, and inserts the others.
TEST(RateInsertion, StartsFromAFrame) {
  Case c = falling_in(12, 60);
  Simulation a(c, {});
  while (active(a.frame()) < 5) a.step();
  Frame const frame = a.frame();
  Simulation b(c, {}, frame);
  EXPECT_EQ(b.frame().activity, frame.activity);
  EXPECT_EQ(b.frame().position, frame.position);
  run(b);
  EXPECT_EQ(active(b.frame()), 12);
  EXPECT_LT(std::abs(b.ledger().residual), 1e-3 * b.ledger().moved);
}

TEST(RateInsertion, ABlockedGrainIsReportedAndGetsInWhenTheBoxIsFree) {
  Case c = rock_case();
  // The box holds one grain; it leaves at 1 m/s, so one every 0.1 s gets in although 100 a second are due.
  c.grains = {grains_in({{0, 0, 0}, {0.1, 0.1, 0.1}}, 5, Kind::rate)};
  c.grains[0].insert.rate = 100;
  c.grains[0].insert.velocity = {1, 0, 0};
  c.grains[0].insert.box.max = {0.1 * (1 + 1e-9), 0.1 * (1 + 1e-9), 0.1 * (1 + 1e-9)};
  c.time.step = 1e-3;
  c.time.end = 0.35;
  Simulation s(c, {});
  std::string told;
  while (s.step() == RunState::running) {
  }
  for (std::string const& m : s.messages()) told += m + "\n";
  EXPECT_EQ(active(s.frame()), 4);  // at 0, 0.1, 0.2 and 0.3 s
  EXPECT_NE(told.find("insertion of grains 'inserted' is blocked: grain 2"), std::string::npos) << told;
  EXPECT_NE(told.find("1 of 5 are not inserted; blocked 1 time, 0.34 s"), std::string::npos) << told;
  EXPECT_EQ(s.largest_overlap(), 0);
}

TEST(RateInsertion, RestIsNotReachedWhileGrainsAreDue) {
  Case c = falling_in(2, 10);
  c.time.settle = SettleCase{5, 0, 1e-6, 0.01};
  c.grains[0].insert.start = 0.3;
  c.grains[0].insert.box = {{-0.3, -0.3, 0.05}, {0.3, 0.3, 0.2}};
  c.time.end = 3;
  Simulation s(c, {});
  run(s);
  EXPECT_EQ(s.state(), RunState::at_rest);
  EXPECT_EQ(active(s.frame()), 2);
  EXPECT_GT(s.time(), 0.4);
}

TEST(RateInsertion, PlanHasAStageAColumnAndANote) {
  Case c = falling_in(20, 10);
  Simulation s(c, {});
  Plan const plan = s.plan();
  EXPECT_EQ(plan.stages.front(), "insertion");
  EXPECT_EQ(s.results_header().ledger, (std::vector<std::string>{"inserted"}));
  EXPECT_TRUE(s.results_header().activity);
  std::string notes;
  for (std::string const& note : plan.notes) notes += note + "\n";
  EXPECT_NE(notes.find("20 inserted from t = 0 s to 1.9 s, beyond time.end = 0.5 s: 6 get in"), std::string::npos)
      << notes;
  // Nothing to insert: the plain scene.
  Case empty = falling_in(0, 10);
  Simulation const none(empty, {});
  EXPECT_EQ(none.plan().stages.front(), "bounds");
  EXPECT_FALSE(none.results_header().activity);
  for (Plan::Array const& array : none.plan().arrays) EXPECT_NE(array.name, "activity");
}

// Pictures, meshes and meters of a frame show active bodies only.
TEST(InactiveBodies, AreNotSeen) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0, 0, 0}, {0.09, 0, 0}, {0.18, 0, 0}})};
  Simulation const s(c, {});
  ResultsHeader h = s.results_header();
  Frame f = s.frame();
  EXPECT_EQ(measure_overlap(h, f, 1000, 1).contacts, 2);
  f.activity = {Activity::active, Activity::active, Activity::pending};
  OverlapReport const r = measure_overlap(h, f, 1000, 1);
  EXPECT_EQ(r.contacts, 1);
  EXPECT_EQ(r.coordination, 1);
  EXPECT_EQ(grain_meshes(h, f, 200).size(), 2u);
  GrainRays const rays(h, f);
  std::vector<RayHit> hits;
  rays.trace({{{0.09, 0, 5}, {0, 0, -1}}, {{0.18, 0, 5}, {0, 0, -1}}}, hits);
  EXPECT_EQ(hits[0].body, 1);
  EXPECT_EQ(hits[1].body, -1);
  f.activity.assign(3, Activity::deleted);
  EXPECT_EQ(measure_overlap(h, f, 1000, 1).contacts, 0);
  EXPECT_TRUE(GrainRays(h, f).empty());
}

}  // namespace
}  // namespace scree
