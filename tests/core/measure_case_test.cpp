// measure_case_test.cpp: [[measure]] in the case file, the plan, the results; and that measuring changes nothing.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/measure_kinds.h"
#include "tests/support/measures.h"

namespace scree {
namespace {

using namespace testing;

std::string const plain = R"([time]
end = 0.1
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e6 }
friction = 0.5
[[grains]]
name = "grain"
material = "rock"
shapes = ["sphere"]
diameter = 0.1
insert = { kind = "list", position = [[0, 0, 0.06], [0.11, 0, 0.06], [0.05, 0, 0.16]], velocity = [0.3, 0, -1] }
[[wall]]
name = "floor"
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "rock"
[[delete]]
name = "far"
kind = "plane"
point = [50, 0, 0]
normal = [-1, 0, 0]
)";

// An entry of every kind.
std::string const every_kind = R"([[measure]]
name = "bed"
kind = "packing_fraction"
box = [[-1, -1, 0], [1, 1, 0.1]]
slices = 3
points = 500
[[measure]]
name = "z"
kind = "coordination"
cylinder = { from = [0, 0, 0], to = [0, 0, 1], radius = 0.5 }
every = 0.01
from = 0.02
until = 0.05
[[measure]]
name = "heap"
kind = "pile_angle"
through = [0, 0, 0]
bin = 0.1
flank = [0.1, 0.9]
[[measure]]
name = "slope"
kind = "surface_angle"
axis = [0, 1, 0]
through = [0, 0, 0]
radius = 1
[[measure]]
name = "turn"
kind = "wall_torque"
wall = "floor"
axis = [0, 1, 0]
through = [0, 0, 0]
[[measure]]
name = "push"
kind = "wall_force"
wall = "floor"
[[measure]]
name = "out"
kind = "discharge_rate"
point = [0.2, 0, 0]
normal = [1, 0, 0]
[[measure]]
name = "gone"
kind = "discharge_rate"
delete = "far"
[[measure]]
name = "arch"
kind = "blockage"
point = [0, 0, 0]
normal = [0, 0, -1]
longer_than = 0.05
[[measure]]
name = "stress"
kind = "stress"
box = [[-1, -1, 0], [1, 1, 1]]
[[measure]]
name = "chains"
kind = "force_chains"
above = 1.5
contacts = true
[[measure]]
name = "path"
kind = "trajectory"
grains = "grain"
index = [0, 2]
[[measure]]
name = "speed"
kind = "velocity"
[[measure]]
name = "run"
kind = "run_out"
direction = [1, 0, 0]
)";

Case loaded(std::string const& text) {
  auto const file = std::filesystem::temp_directory_path() / ("measure-" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file) << text;
  try {
    Case c = load_case(file, {});
    std::filesystem::remove(file);
    return c;
  } catch (...) {
    std::filesystem::remove(file);
    throw;
  }
}

std::string refusal(std::string const& entry) {
  try {
    loaded(plain + "[[measure]]\n" + entry);
  } catch (InputError const& e) {
    std::string all;
    for (std::string const& p : e.problems) all += p + "\n";
    return all;
  }
  return "";
}

TEST(MeasureCase, EveryKindIsReadAndWrittenOutTheSame) {
  Case const c = loaded(plain + every_kind);
  for (MeasureKind const& kind : measure_kinds())
    EXPECT_TRUE(std::any_of(c.measure.begin(), c.measure.end(), [&](auto const& m) { return m.kind == kind.name; }))
        << kind.name;
  std::string const text = to_toml(c);
  EXPECT_EQ(to_toml(loaded(text)), text);
  EXPECT_EQ(c.measure[1].every, 0.01);
  EXPECT_EQ(c.measure[1].from, 0.02);
  EXPECT_EQ(c.measure[1].until, 0.05);
  EXPECT_EQ(c.measure[1].cylinder->radius, 0.5);
  EXPECT_EQ(c.measure[2].flank_low, 0.1);
}

TEST(MeasureCase, WrongEntriesAreRefusedWithTheWayOut) {
  auto const says = [](std::string const& entry, std::string const& word) {
    std::string const all = refusal(entry);
    EXPECT_NE(all.find(word), std::string::npos) << entry << "\n" << all;
  };
  says("name = 'a'\nkind = 'coordinaton'\n", "did you mean 'coordination'");
  says("name = 'a'\nkind = 'packing_fraction'\n", "give the region as box or cylinder");
  says("name = 'a'\nkind = 'coordination'\nwall = 'floor'\n", "measure.a.wall");
  says("name = 'a'\nkind = 'wall_force'\nwall = 'flor'\n", "did you mean 'floor'");
  says("name = 'a'\nkind = 'wall_torque'\nwall = 'floor'\n", "needs axis and through");
  says("name = 'a'\nkind = 'discharge_rate'\n", "one of both");
  says("name = 'a'\nkind = 'discharge_rate'\ndelete = 'far'\npoint = [0, 0, 0]\nnormal = [1, 0, 0]\n", "one of both");
  says("name = 'a'\nkind = 'surface_angle'\naxis = [0, 0, 1]\nthrough = [0, 0, 0]\n", "axis is vertical");
  says("name = 'a'\nkind = 'coordination'\nfrom = 1\nuntil = 0.5\n", "must lie after");
  says("name = 'a'\nkind = 'coordination'\nbox = [[0, 0, 0], [1, 1, -1]]\n", "must exceed");
  says("name = 'a'\nkind = 'trajectory'\ngrains = 'grain'\nindex = [3]\n", "none of the 3 grains");
  says("name = 'a'\nkind = 'run_out'\ndirection = [0, 0, 2]\n", "is vertical");
  says("name = 'a'\nkind = 'blockage'\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n", "longer_than");
  says("name = 'a.b'\nkind = 'coordination'\n", "must be a word");
  says("name = 'a'\nkind = 'coordination'\n[[measure]]\nname = 'a'\nkind = 'coordination'\n", "used twice");
  says("name = 'a'\nkind = 'coordination'\nevery = 0\n", "must be > 0");
}

TEST(Measurements, ChangeNoBitAndAreNoStageWhenAbsent) {
  Case const without = loaded(plain), with = loaded(plain + every_kind);
  SimulationOptions two;
  two.threads = 2;
  Simulation a(without, {}), b(with, {}), d(with, two);
  std::vector<std::string> stages = a.plan().stages;
  EXPECT_EQ(std::count(stages.begin(), stages.end(), "measure"), 0);
  stages.push_back("measure");
  EXPECT_EQ(b.plan().stages, stages);
  EXPECT_EQ(a.plan().effects, b.plan().effects);
  run_to_end(a), run_to_end(d);
  EXPECT_TRUE(a.measure_summary().empty());
  EXPECT_TRUE(a.measure_rows().empty());
  for (Profile::Entry const& e : a.profile().entries()) EXPECT_FALSE(e.name.starts_with("measure")) << e.name;
  Measured const m = run_to_end(b);
  EXPECT_GT(m.at("push.z").samples, 0);
  EXPECT_EQ(a.steps(), b.steps());
  EXPECT_EQ(a.frame().position, b.frame().position);
  EXPECT_EQ(a.frame().velocity, b.frame().velocity);
  EXPECT_EQ(a.frame().spin, b.frame().spin);
  EXPECT_EQ(a.ledger().residual, b.ledger().residual);
  auto const rows = b.measure_rows(), same = d.measure_rows();
  ASSERT_EQ(rows.size(), same.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t q = 0; q < rows[i].value.size(); ++q)
      EXPECT_TRUE(rows[i].value[q] == same[i].value[q] || std::isnan(rows[i].value[q])) << i;
}

// Samples every 0.01 s of a run of 0.1 s; the window takes those at 0.02 to 0.05 s.
TEST(Measurements, AreTakenOnTimeAndAveragedOverTheirWindow) {
  Simulation s(loaded(plain + every_kind), {});
  Measured const m = run_to_end(s);
  EXPECT_EQ(m.at("z.together").samples, 4);
  EXPECT_TRUE(m.at("z.together").windowed);
  EXPECT_FALSE(m.at("bed.fraction").windowed);
  double mean = 0, square = 0;
  int taken = 0;
  for (MeasureRow const& row : s.measure_rows()) {
    if (row.measure != 1) continue;
    ++taken;
    EXPECT_NEAR(row.time, 0.01 * taken, s.time_step());
    if (taken >= 2 && taken <= 5) mean += row.value[2] / 4, square += row.value[2] * row.value[2] / 4;
  }
  EXPECT_EQ(taken, 10);
  EXPECT_NEAR(m.at("z.together").mean, mean, 1e-12);
  EXPECT_NEAR(m.at("z.together").spread, std::sqrt(std::max(0.0, square - mean * mean) * 4 / 3), 1e-7);
}

TEST(Measurements, ComeBackFromTheResultsFile) {
  Simulation s(loaded(plain + every_kind), {});
  run_to_end(s);
  auto const file = std::filesystem::temp_directory_path() / ("measure-" + std::to_string(::getpid()) + ".h5");
  auto const write = [&](std::vector<MeasureSummary> const& measures) {
    ResultsWriter writer(file, s.results_header());
    writer.write_frame(s.frame());
    writer.write_ledger(s.ledger());
    writer.write_measures(measures);
    writer.finish({});
  };
  std::vector<MeasureSummary> const written = s.measure_summary();
  write(written);
  std::vector<MeasureSummary> const read = ResultsReader(file).measures();
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].name, written[i].name);
    EXPECT_EQ(read[i].unit, written[i].unit);
    EXPECT_EQ(read[i].windowed, written[i].windowed);
    EXPECT_EQ(read[i].samples, written[i].samples);
    EXPECT_TRUE(read[i].mean == written[i].mean || std::isnan(written[i].mean)) << read[i].name;
    EXPECT_TRUE(read[i].last == written[i].last || std::isnan(written[i].last)) << read[i].name;
  }
  std::filesystem::remove(file);
  write({});
  EXPECT_TRUE(ResultsReader(file).measures().empty());
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace scree
