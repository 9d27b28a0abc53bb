// measure_replica_test.cpp: what meters say of replicas and entries apart: sums, means, or a refusal with a way out.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/grain_entries.h"
#include "core/measure_kinds.h"
#include "tests/support/measures.h"

namespace scree {
namespace {

using namespace testing;

// A handful of grains that fall on a floor, random in each replica.
Case falling() {
  Case c = rock_case();
  c.seed = 11;
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.5;
  GrainsCase g = grains_at("ellipsoid:1:0.8:0.6", {}, 0.1, 100);
  g.count = 6;
  g.insert.kind = InsertCase::Kind::random;
  g.insert.orientation = Orientation::random;
  g.insert.box = {{-0.2, -0.2, 0.02}, {0.2, 0.2, 0.42}};
  g.insert.velocity = {0.2, 0, -1};
  c.grains = {g};
  c.wall = {open_box({-0.2, -0.2, 0}, {0.2, 0.2, 0.6})};
  c.time.end = 0.15;
  c.time.step = 1e-4;
  c.output.every = 0.05;
  return c;
}

// Every kind with the keys it needs.
MeasureCase of_kind(std::string const& kind) {
  MeasureCase m = measure(kind, kind);
  m.box = Box{{-0.2, -0.2, 0}, {0.2, 0.2, 0.25}};
  if (kind.starts_with("wall_")) m.wall = "container";
  if (kind == "wall_torque" || kind == "surface_angle") m.axis = Vec3{0, 1, 0}, m.through = Vec3{};
  if (kind == "discharge_rate" || kind == "blockage") m.point = Vec3{0, 0, 0.15}, m.normal = Vec3{0, 0, -1};
  if (kind == "blockage") m.longer_than = 0.1;
  if (kind == "trajectory") m.grains = "grain";
  if (kind == "run_out") m.direction = Vec3{1, 0, 0};
  return m;
}

std::vector<std::string> refused(Case const& c) {
  std::vector<std::string> out;
  for (std::string const& line : problems(c)) {
    EXPECT_TRUE(line.starts_with("measure.") && line.find(".kind: '") != std::string::npos) << line;
    out.push_back(line.substr(8, line.find(".kind") - 8));
  }
  return out;
}

TEST(MeasuredReplicas, WhatTellsOfOneSceneIsRefusedForSeveral) {
  Case c = falling();
  for (MeasureKind const& k : measure_kinds()) c.measure.push_back(of_kind(k.name));
  EXPECT_EQ(problems(c), std::vector<std::string>{});
  c.replicas = 3;
  EXPECT_EQ(refused(c), (std::vector<std::string>{"pile_angle", "surface_angle", "blockage", "stress"}));
  for (std::string const& line : problems(c)) {
    EXPECT_NE(line.find("for 3 replicas at once"), std::string::npos) << line;
    EXPECT_NE(line.find("case.replicas = 1 and the seed of each"), std::string::npos) << line;
  }
  c.replicas = 1;
  c.grains[0].apart = true;  // from nobody: one world
  EXPECT_EQ(problems(c), std::vector<std::string>{});
  c.grains.push_back(c.grains[0]);
  c.grains[1].name = "other";
  EXPECT_EQ(refused(c),
            (std::vector<std::string>{"packing_fraction", "pile_angle", "surface_angle", "blockage", "stress"}));
  for (std::string const& line : problems(c)) EXPECT_NE(line.find("a case of its own"), std::string::npos) << line;
  c.grains[1].count = 0;
  EXPECT_EQ(problems(c), std::vector<std::string>{});
}

TEST(MeasuredReplicas, SumsAndMeansAreThoseOfTheSingleRuns) {
  Case c = falling();
  for (char const* kind : {"packing_fraction", "coordination", "wall_torque", "wall_force", "discharge_rate",
                           "velocity", "run_out", "trajectory"}) {
    c.measure.push_back(of_kind(kind));
    if (c.measure.back().kind != "packing_fraction") c.measure.back().box.reset();  // so that each counts 6 grains
  }
  c.measure[0].slices = 2;
  int constexpr replicas = 3;
  c.replicas = replicas;
  Simulation together(c, {});
  Measured all = run_to_end(together);
  std::map<std::string, double> sum, most;
  for (int r = 0; r < replicas; ++r) {
    Case one = c;
    one.replicas = 1;
    one.seed = replica_seed(c.seed, r);
    Simulation single(one, {});
    for (auto const& [name, m] : run_to_end(single)) {
      sum[name] += m.last;
      most[name] = r == 0 ? m.last : std::max(most[name], m.last);
      if (name.starts_with("trajectory.")) {  // grains count on through the replicas
        std::size_t const dot = name.find('.', 11);
        int const grain = std::stoi(name.substr(11, dot - 11)) + r * c.grains[0].count;
        EXPECT_EQ(all.at("trajectory." + std::to_string(grain) + name.substr(dot)).last, m.last) << name;
      }
    }
  }
  auto const expect = [&](std::string const& name, double value) {
    EXPECT_NE(value, 0) << name;                                             // or it would say nothing
    EXPECT_NEAR(all.at(name).last, value, 1e-10 * std::abs(value)) << name;  // sums in another order may cancel
  };
  for (char const* name :
       {"packing_fraction.fraction", "packing_fraction.slice_0", "packing_fraction.slice_1", "coordination.walls",
        "coordination.together", "velocity.mean", "velocity.x", "velocity.spin", "run_out.mean"})
    expect(name, sum[name] / replicas);
  for (char const* name : {"wall_torque.torque", "wall_force.z", "discharge_rate.mass", "discharge_rate.number",
                           "discharge_rate.mass_rate"})
    expect(name, sum[name]);
  for (char const* name : {"velocity.largest", "run_out.largest"}) expect(name, most[name]);
}

// The stated error is that of random points: of the mean of N alike it falls as 1 / sqrt(N).
TEST(MeasuredReplicas, ErrorOfAMeanFractionFalls) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0.5, 0.5, 1.02}})};  // cut by the border
  c.measure = {measure("bed", "packing_fraction")};
  c.measure[0].box = Box{{0, 0, 0}, {1, 1, 1}};
  Measured one = measured_at_once(c);
  c.replicas = 4;
  Measured four = measured_at_once(c);
  EXPECT_GT(one["bed.error"].last, 0);
  EXPECT_NEAR(four["bed.fraction"].last, one["bed.fraction"].last, 1e-15);
  EXPECT_NEAR(four["bed.error"].last, one["bed.error"].last / 2, 1e-15);
}

}  // namespace
}  // namespace scree
