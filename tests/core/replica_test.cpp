// replica_test.cpp: replicas and entries apart: what meets whom, whose seed is whose, and the same bits as single runs.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/grain_entries.h"
#include "core/overlap_meter.h"
#include "core/simulation_impl.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
using Kind = InsertCase::Kind;

void run(Simulation& s) {
  while (s.step() == RunState::running) {
  }
}

GrainsCase grains_in(std::string const& name, std::string const& shape, Box const& box, int count, Kind kind) {
  GrainsCase g = grains_at(shape, {}, 0.1, 100);
  g.name = name;
  g.count = count;
  g.insert.kind = kind;
  g.insert.box = box;
  g.insert.orientation = Orientation::random;
  return g;
}

// Every way to start, friction, a wall that moves and one that takes grains away.
Case busy_case() {
  Case c = rock_case();
  c.seed = 7;
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.3;
  c.grains = {grains_in("random", "ellipsoid:1:0.8:0.6", {{-0.3, -0.3, 0}, {0.3, 0.3, 0.3}}, 4, Kind::random),
              grains_in("rate", "sphere", {{-0.2, -0.2, 0.35}, {0.2, 0.2, 0.6}}, 3, Kind::rate),
              grains_in("lattice", "box:1:0.8:0.6", {{-0.3, -0.3, 0.6}, {0.3, 0.3, 0.9}}, 4, Kind::lattice),
              grains_at("sphere", {{0, 0, 0.95}, {0, 0, 1.2}})};
  c.grains[1].insert.rate = 60;
  c.grains[2].shapes = {"box:1:0.8:0.6", "ellipsoid:1:1:0.5"};
  c.grains[2].least_diameter = 0.08;
  c.grains[3].name = "list";
  c.grains[3].insert.orientation = Orientation::random;
  c.grains[3].insert.scatter = {0.05, 0.1, 0.02};
  WallCase mill = floor_at(0);
  mill.name = "mill";
  mill.kind = WallKind::capsule;
  mill.from = {0, -0.2, 0.05}, mill.to = {0, 0.2, 0.05};
  mill.radius = 0.03;
  mill.inside = false;
  mill.motion = MotionCase{};
  mill.motion->axis = {0, 0, 1};
  mill.motion->rate = 20;
  c.wall = {floor_at(-0.05), mill};
  c.deletion.resize(1);
  c.deletion[0].name = "far";
  c.deletion[0].plane = true;
  c.deletion[0].point = {0.25, 0, 0};
  c.deletion[0].normal = {-1, 0, 0};
  c.time.end = 0.15;
  c.time.step = 5e-5;
  return c;
}

TEST(Replicas, EachIsBitByBitTheSingleRunWithItsSeed) {
  Case c = busy_case();
  c.replicas = 3;
  Simulation all(c, {.threads = 2});
  run(all);
  Frame const f = all.frame();
  ResultsHeader const header = all.results_header();
  std::size_t const n = f.position.size() / 3;
  LedgerRow sum;
  bool any_deleted = false, any_inserted = false;
  for (int r = 0; r < 3; ++r) {
    Case alone = busy_case();
    alone.seed = replica_seed(c.seed, r);
    Simulation single(alone, {});
    run(single);
    Frame const g = single.frame();
    ASSERT_EQ(g.position.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t const k = r * n + i;
      EXPECT_EQ(f.position[k], g.position[i]) << "replica " << r << ", grain " << i;
      EXPECT_EQ(f.velocity[k], g.velocity[i]);
      EXPECT_EQ(f.spin[k], g.spin[i]);
      EXPECT_EQ(f.activity[k], g.activity[i]);
      EXPECT_EQ(header.replica[k], r);
      EXPECT_EQ(header.shape[k], single.results_header().shape[i]);
      any_deleted = any_deleted || g.activity[i] == Activity::deleted;
      any_inserted = any_inserted || (header.group[k] == 1 && g.activity[i] == Activity::active);
    }
    sum.kinetic += single.ledger().kinetic, sum.friction += single.ledger().friction;
    sum.deleted += single.ledger().deleted, sum.inserted += single.ledger().inserted;
    sum.wall_work += single.ledger().wall_work;
  }
  EXPECT_TRUE(any_deleted && any_inserted);
  LedgerRow const row = all.ledger();  // sums in another order: rounding
  EXPECT_NEAR(row.kinetic, sum.kinetic, 1e-12 * sum.kinetic);
  EXPECT_NEAR(row.friction, sum.friction, 1e-12 * sum.friction);
  EXPECT_NEAR(row.inserted, sum.inserted, 1e-12 * std::abs(sum.inserted));
  EXPECT_NEAR(row.deleted, sum.deleted, 1e-12 * std::abs(sum.deleted));
  EXPECT_NEAR(row.wall_work, sum.wall_work, 1e-12 * std::abs(sum.wall_work));
  EXPECT_EQ(row.inserted != 0 && row.deleted != 0 && row.wall_work != 0 && row.friction > 0, true);
}

TEST(Replicas, SeedsDifferAndTheFirstIsTheCasesOwn) {
  std::set<std::uint64_t> seeds;
  for (std::uint64_t const seed : {0, 1, 2, 3})
    for (int r = 0; r < 100; ++r) {
      seeds.insert(replica_seed(seed, r));
      EXPECT_LT(replica_seed(seed, r), std::uint64_t{1} << 63);
    }
  EXPECT_EQ(seeds.size(), 400u);
  EXPECT_EQ(replica_seed(5, 0), 5u);
}

// Grains at one spot that never push each other fall like one alone; the wall stops them all.
TEST(Replicas, GrainsAtTheSameSpotNeverMeet) {
  for (char const* const shape : {"sphere", "ellipsoid:1:1:0.5"}) {
    Case c = rock_case();
    c.gravity = Vec3{0, 0, -9.81};
    c.grains = {grains_at(shape, {{0, 0, 0.2}}), grains_at(shape, {{0.01, 0, 0.2}})};
    c.grains[1].name = "other";
    c.wall = {floor_at(0)};
    c.time.end = 0.3;
    c.time.step = 5e-5;
    c.replicas = 2;
    for (GrainsCase& g : c.grains) g.apart = true;
    Simulation together(c, {});
    EXPECT_EQ(measure_overlap(together.results_header(), together.frame(), 2000, 1).contacts, 0);
    run(together);
    Case one = c;
    one.replicas = 1;
    one.grains.resize(1);
    Simulation alone(one, {});
    run(alone);
    double const z = alone.frame().position[0].z;
    EXPECT_GT(z, 0);  // the floor held it
    for (Vec3 const& x : together.frame().position) EXPECT_EQ(x.z, z);
    // Without `apart` and replicas the two push each other at once.
    c.replicas = 1;
    for (GrainsCase& g : c.grains) g.apart = false;
    c.grains[1].insert.position[0].x = 0.09;
    Simulation meeting(c, {});
    meeting.step();
    EXPECT_EQ(measure_overlap(meeting.results_header(), meeting.frame(), 2000, 1).contacts, 1);
    EXPECT_LT(meeting.frame().velocity[0].x, 0);
    EXPECT_GT(meeting.frame().velocity[1].x, 0);
  }
}

TEST(Apart, GrainsOfOneEntryStillMeet) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0, 0, 0}, {0.09, 0, 0}}), grains_at("sphere", {{0, 0.09, 0}}),
              grains_at("sphere", {{0, -0.09, 0}})};
  c.grains[1].name = "b", c.grains[2].name = "c";
  c.grains[0].apart = true;
  Simulation s(c, {});
  std::vector<Pair> const expected = {{0, 1}};
  EXPECT_EQ(s.impl().work.pair, expected);
  c.grains[2].insert.position = {{0, 0.18, 0}};  // those that do not keep apart meet each other
  Simulation others(c, {});
  EXPECT_EQ(others.impl().work.pair, (std::vector<Pair>{{0, 1}, {2, 3}}));
}

TEST(Replicas, ListsGiveWhatBruteForceGives) {
  Case c = busy_case();
  c.replicas = 2;
  c.time.end = 0.05;
  for (GrainsCase& g : c.grains) g.apart = g.name != "list";
  Simulation lists(c, {}), brute(c, {.brute_force = true});
  run(lists), run(brute);
  EXPECT_EQ(lists.frame().position, brute.frame().position);
  EXPECT_EQ(lists.frame().spin, brute.frame().spin);
}

// A box with room for one grain holds one of each entry and replica.
TEST(Apart, RandomPlacesAreUsedSeveralTimes) {
  Case c = rock_case();
  for (Kind const kind : {Kind::random, Kind::lattice, Kind::rate}) {
    Box const box{{0, 0, 0}, {0.11, 0.11, 0.11}};
    c.grains = {grains_in("a", "sphere", box, 1, kind), grains_in("b", "sphere", box, 1, kind)};
    for (GrainsCase& g : c.grains) g.apart = true, g.insert.rate = 100;
    c.replicas = 2;
    c.time.step = 1e-4;
    Simulation s(c, {});
    s.step();
    Frame const f = s.frame();
    ASSERT_EQ(f.position.size(), 4u);
    for (int i = 0; i < 4; ++i) {
      EXPECT_TRUE(f.is_active(i));
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(f.position[i][k], 0.055, 0.005 + 1e-9);
    }
    for (GrainsCase& g : c.grains) g.apart = false;
    if (kind == Kind::rate) {
      Simulation blocked(c, {});
      blocked.step();
      EXPECT_FALSE(blocked.frame().is_active(1));
    } else {
      EXPECT_THROW(Simulation(c, {}), InputError);
    }
  }
}

TEST(Replicas, ScatterStaysWithinItsBoxAndLeavesTheRestAlone) {
  Case c = rock_case();
  std::vector<Vec3> const places(200, Vec3{1, 2, 3});
  c.grains = {grains_at("sphere", places)};
  c.grains[0].insert.orientation = Orientation::random;
  Simulation const still(c, {});
  c.grains[0].insert.scatter = {0.5, 0, 0.25};
  Simulation const s(c, {});
  EXPECT_EQ(s.frame().orientation[7].w, still.frame().orientation[7].w);
  double low = 1, high = -1;
  for (Vec3 const& x : s.frame().position) {
    low = std::min(low, (x.x - 1) / 0.5), high = std::max(high, (x.x - 1) / 0.5);
    EXPECT_EQ(x.y, 2);
    EXPECT_LE(std::abs(x.z - 3), 0.25);
  }
  // Of 200 uniform draws none within 10 % of an end has the odds 0.95^200 < 4e-5.
  EXPECT_TRUE(low >= -1 && low < -0.9 && high <= 1 && high > 0.9) << low << ' ' << high;
  EXPECT_NE(s.frame().position[0], s.frame().position[1]);
}

TEST(Replicas, AbsentKeysAddNothing) {
  Case c = busy_case();
  Plan const plain = Simulation(c, {}).plan();
  auto const has = [](Plan const& p) {
    return std::any_of(p.arrays.begin(), p.arrays.end(), [](Plan::Array const& a) { return a.name == "worlds"; });
  };
  EXPECT_FALSE(has(plain));
  c.grains.resize(1);
  c.grains[0].apart = true;  // from nobody
  Simulation one(c, {});
  EXPECT_FALSE(has(one.plan()));
  EXPECT_TRUE(one.results_header().world.empty());
  c.replicas = 2;
  Simulation two(c, {});
  Plan const replicas = two.plan();
  EXPECT_TRUE(has(replicas));
  EXPECT_EQ(replicas.stages, one.plan().stages);
  EXPECT_EQ(replicas.bodies, 2 * one.plan().bodies);
  EXPECT_NE(
      replicas.notes[0].find("2 replicas, each by itself the case with seed 7, " + std::to_string(replica_seed(7, 1))),
      std::string::npos)
      << replicas.notes[0];
}

// Materials that never meet need no law.
TEST(Apart, NoContactLawIsNeededBetweenWhatNeverMeets) {
  Case c = rock_case();
  c.material.push_back({"ice", 917});
  c.grains = {grains_at("sphere", {{0, 0, 0}}), grains_at("sphere", {{0, 0, 0}})};
  c.grains[1].name = "ice", c.grains[1].material = "ice";
  EXPECT_EQ(problems(c).size(), 1u);
  c.grains[1].apart = true;
  EXPECT_EQ(problems(c), std::vector<std::string>{});
  EXPECT_NO_THROW(Simulation(c, {}));
  c.replicas = 0;
  ASSERT_EQ(problems(c).size(), 1u);
  EXPECT_NE(problems(c)[0].find("case.replicas: 0 is out of range: must be >= 1"), std::string::npos);
}

}  // namespace
}  // namespace scree
