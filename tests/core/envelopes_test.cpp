// envelopes_test.cpp: envelopes of grains in flight, all in closed form; replicas and files counted right.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/envelopes.h"
#include "core/results.h"
#include "core/simulation.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

double constexpr g = 9.81;

class EnvelopeFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_envelopes_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Runs the case and writes every frame that output.every asks for.
  fs::path run(Case const& c, std::string const& name) const {
    Simulation s(c, {});
    fs::path const file = folder_ / (name + ".h5");
    ResultsWriter writer(file, s.results_header());
    writer.write_frame(s.frame());
    double next = c.output.every;
    while (true) {
      RunState const state = s.step();
      Frame const frame = s.frame();
      if (state != RunState::running || frame.time >= next - 1e-9) writer.write_frame(frame), next += c.output.every;
      if (state != RunState::running) break;
    }
    writer.finish({});
    return file;
  }

  fs::path folder_;
};

// Grain i starts at (0.01 + 0.3 i, 0.1 + 0.2 i, 10) with 2 m/s along x and 3 m/s up, and turns about a principal axis:
// it flies.
Case flight(int grains) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -g};
  std::vector<Vec3> place;
  for (int i = 0; i < grains; ++i) place.push_back({0.01 + 0.3 * i, 0.1 + 0.2 * i, 10});
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", place, 0.1, 100)};
  c.grains[0].insert.velocity = {2, 0, 3};
  c.grains[0].insert.spin = {0, 0, 5};
  c.time.end = 1;
  c.time.step = 1e-3;
  c.output.every = 0.05;
  MeasureCase m;
  m.name = "way", m.kind = "run_out", m.direction = Vec3{3, 0, 7};  // only its horizontal part counts
  c.measure = {m};
  return c;
}

// Ellipsoid of axes 1 : 0.8 : 0.6 and the volume of a sphere of d; c is its half axis along z.
double rotation_energy(double d, double spin) {
  double const a = 0.5 * d / std::cbrt(0.8 * 0.6);
  double const gyration = (a * a + 0.64 * a * a) / 5;  // I_zz / m
  return 0.5 * gyration * spin * spin;
}

TEST_F(EnvelopeFiles, FlightIsInClosedForm) {
  Envelopes const e = measure_envelopes({run(flight(2), "flight")}, {.bin = 0.25});
  EXPECT_NEAR(norm(e.along - Vec3{1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(e.across - Vec3{0, 1, 0}), 0, 1e-12);
  ASSERT_EQ(e.group.size(), 1u);
  EnvelopeGroup const& group = e.group[0];
  EXPECT_EQ(group.name, "grain");
  EXPECT_EQ(group.grains, 2);
  EXPECT_EQ(group.replicas, 1);
  ASSERT_EQ(e.grain.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    GrainWay const& way = e.grain[i];
    EXPECT_EQ(way.fate, Fate::moving);
    EXPECT_NEAR(way.run_out, 2, 1e-9);  // 2 m/s for 1 s
    EXPECT_NEAR(way.sideways, 0, 1e-12);
    EXPECT_NEAR(norm(way.release - Vec3{0.01 + 0.3 * i, 0.1 + 0.2 * i, 10}), 0, 1e-12);
    EXPECT_NEAR(norm(way.end - Vec3{2.01 + 0.3 * i, 0.1 + 0.2 * i, 10 + 3 - g / 2}), 0, 1e-9);
    EXPECT_NEAR(way.largest_speed, std::hypot(2, 3 - g), 1e-9);
  }
  // Screens 0.25 m apart: the first grain comes through 0.25 ... 2, the second through 0.5 ... 2.25, each at
  // t = (x - x0) / 2. Kinetic energy per mass:
  double const turning = rotation_energy(0.1, 5);
  auto const energy = [&](double t) { return 0.5 * (4 + std::pow(3 - g * t, 2)) + turning; };
  ASSERT_EQ(group.screen.size(), 9u);
  for (int k = 1; k <= 9; ++k) {
    EnvelopeGroup::Screen const& screen = group.screen[k - 1];
    EXPECT_NEAR(screen.along, 0.25 * k, 1e-12);
    std::vector<double> expected;
    if (k <= 8) expected.push_back(energy((0.25 * k - 0.01) / 2));
    if (k >= 2) expected.push_back(energy((0.25 * k - 0.31) / 2));
    SampleSpread const s = spread_of(expected);
    EXPECT_EQ(screen.energy.count, static_cast<int>(expected.size())) << k;
    // Exact between frames, too; the tolerance is for the ellipsoid's moment of inertia, a sum over its surface.
    EXPECT_NEAR(screen.energy.mean, s.mean, 1e-6) << k;
    EXPECT_NEAR(screen.energy.high, s.high, 1e-6) << k;
    EXPECT_NEAR(screen.energy.largest, s.largest, 1e-6) << k;
    EXPECT_NEAR(screen.rotation, turning, 1e-6) << k;
  }
  // Speeds every 0.05 s from the release on.
  ASSERT_EQ(group.moment.size(), 21u);
  for (int k = 0; k <= 20; ++k) {
    double const speed = std::hypot(2, 3 - g * 0.05 * k);
    EXPECT_NEAR(group.moment[k].time, 0.05 * k, 1e-12);
    EXPECT_EQ(group.moment[k].speed.count, 2);
    for (double const s : {group.moment[k].speed.mean, group.moment[k].speed.low, group.moment[k].speed.largest})
      EXPECT_NEAR(s, speed, 1e-9);
  }
}

TEST_F(EnvelopeFiles, MapAndHistogramCountEachGrainOnce) {
  // Bins of 0.7 m: 2 m end in the third, [1.4, 2.1). Cells: grain 0 goes from 0.01 to 2.01 through three of the row
  // across = 0.35, grain 1 from 0.31 to 2.31 through four of it.
  Envelopes const e = measure_envelopes({run(flight(2), "map")}, {.bin = 0.7});
  EnvelopeGroup const& group = e.group[0];
  ASSERT_EQ(group.bin.size(), 1u);
  EXPECT_NEAR(group.bin[0].from, 1.4, 1e-12);
  EXPECT_EQ(group.bin[0].stopped, 2);
  EXPECT_EQ(group.bin[0].left, 0);
  EXPECT_EQ(group.bin[0].beyond, 1);
  ASSERT_EQ(group.cell.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(group.cell[i].along, 0.7 * (i + 0.5), 1e-12);
    EXPECT_NEAR(group.cell[i].across, 0.35, 1e-12);
    EXPECT_EQ(group.cell[i].passed, i < 3 ? 2 : 1);
    EXPECT_EQ(group.cell[i].stopped, i == 2 || i == 3 ? 1 : 0);
  }
  // The same flight seen from a direction 90 degrees to the left: nothing forth, 2 m to the right.
  Envelopes const side = measure_envelopes({folder_ / "map.h5"}, {.direction = Vec3{0, 1, 0}, .bin = 0.7});
  EXPECT_NEAR(side.grain[0].run_out, 0, 1e-12);
  EXPECT_NEAR(side.grain[0].sideways, -2, 1e-9);
  EXPECT_TRUE(side.group[0].screen.empty());
}

// A line across cells without points in the corner cells: exact, however long a leg is.
TEST_F(EnvelopeFiles, DiagonalsPassEveryCellTheyCut) {
  Case c = flight(1);
  c.grains[0].insert.position = {{0.1, 0.3, 10}};
  c.grains[0].insert.velocity = {1, 1, 0};
  c.output.every = 1;  // one leg
  Envelopes const e = measure_envelopes({run(c, "diagonal")}, {.bin = 0.5});
  // y = x + 0.2 from x = 0.1 to 1.1: leaves row 0 at x = 0.3, column 0 at 0.5, row 1 at 0.8, column 1 at 1.
  std::vector<std::pair<double, double>> const expected = {
      {0.25, 0.25}, {0.25, 0.75}, {0.75, 0.75}, {0.75, 1.25}, {1.25, 1.25}};
  ASSERT_EQ(e.group[0].cell.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(e.group[0].cell[i].along, expected[i].first, 1e-12);
    EXPECT_NEAR(e.group[0].cell[i].across, expected[i].second, 1e-12);
    EXPECT_EQ(e.group[0].cell[i].passed, 1);
  }
}

TEST_F(EnvelopeFiles, DeletedGrainsCountWhereTheyLeft) {
  Case c = flight(1);
  c.deletion.resize(1);
  c.deletion[0].name = "border", c.deletion[0].plane = true;
  c.deletion[0].point = {1.06, 0, 0}, c.deletion[0].normal = {-1, 0, 0};
  Envelopes const e = measure_envelopes({run(c, "deleted")}, {.bin = 0.35});
  ASSERT_EQ(e.grain.size(), 1u);
  EXPECT_EQ(e.grain[0].fate, Fate::left);
  EXPECT_GE(e.grain[0].run_out, 1.05);
  EXPECT_LE(e.grain[0].run_out, 1.05 + 2e-3 + 1e-9);  // up to one step of 1 ms farther
  EnvelopeGroup const& group = e.group[0];
  ASSERT_EQ(group.bin.size(), 1u);
  EXPECT_EQ(group.bin[0].left, 1);
  EXPECT_EQ(group.bin[0].stopped, 0);
  // It left 0.525 s after its release: 11 moments from 0 to 0.5 s have it. It came through 0.35, 0.7 and, between the
  // last frame that has it and its end, 1.05: there the energy is linear over the height, (g dt)^2 / 8 off at most.
  EXPECT_EQ(group.moment.size(), 11u);
  ASSERT_EQ(group.screen.size(), 3u);
  double const up = 3 - g * 0.52, exact = 0.5 * (4 + up * up) + rotation_energy(0.1, 5);
  EXPECT_NEAR(group.screen[2].energy.mean, exact, std::pow(g * 0.05, 2) / 8);
}

TEST_F(EnvelopeFiles, ReplicasAndFilesArePooled) {
  Case c = flight(2);
  c.replicas = 3;
  c.grains.push_back(c.grains[0]);
  c.grains[1].name = "slow", c.grains[1].insert.velocity = {1.1, 0, 0};
  c.grains[0].apart = c.grains[1].apart = true;
  fs::path const three = run(c, "three");
  c.replicas = 2;
  c.grains.erase(c.grains.begin());  // "slow" is the first group here
  c.grains[0].insert.velocity = {3.9, 0, 0};
  fs::path const two = run(c, "two");
  Envelopes const e = measure_envelopes({three, two}, {.bin = 0.25});
  ASSERT_EQ(e.group.size(), 2u);
  EXPECT_EQ(e.group[0].name, "grain");
  EXPECT_EQ(e.group[0].replicas, 3);
  EXPECT_EQ(e.group[0].grains, 6);
  EXPECT_EQ(e.group[1].name, "slow");
  EXPECT_EQ(e.group[1].replicas, 5);
  EXPECT_EQ(e.group[1].grains, 10);
  EXPECT_NEAR(e.group[1].run_out.mean, (6 * 1.1 + 4 * 3.9) / 10, 1e-9);
  EXPECT_NEAR(e.group[1].run_out.largest, 3.9, 1e-9);
  EXPECT_EQ(e.group[1].moment[7].speed.count, 10);
  double const up = g * 0.35;
  EXPECT_NEAR(e.group[1].moment[7].speed.mean, (6 * std::hypot(1.1, up) + 4 * std::hypot(3.9, up)) / 10, 1e-9);
  // Grain 0 of every replica comes through the screen at 0.25, grain 1 starts beyond it.
  EXPECT_NEAR(e.group[1].screen[0].along, 0.25, 1e-12);
  EXPECT_EQ(e.group[1].screen[0].energy.count, 5);
  // `beyond` of bins from 1 m on: all; above that the four fast ones.
  EXPECT_EQ(e.group[1].bin.front().beyond, 1);
  EXPECT_NEAR(e.group[1].bin.back().beyond, 0.4, 1e-12);
}

TEST_F(EnvelopeFiles, GrainsAtRestHaveStopped) {
  Case c = flight(1);
  c.gravity.reset();
  c.grains[0].insert.velocity = {};
  EXPECT_EQ(measure_envelopes({run(c, "rest")}, {.direction = Vec3{1, 0, 0}}).grain[0].fate, Fate::stopped);
}

TEST(Spread, PercentilesAreLinearBetweenOrderedValues) {
  std::vector<double> sample;
  for (int i = 100; i >= 0; --i) sample.push_back(i);
  SampleSpread const s = spread_of(sample);
  EXPECT_EQ(s.count, 101);
  EXPECT_DOUBLE_EQ(s.mean, 50);
  EXPECT_DOUBLE_EQ(s.low, 5);
  EXPECT_DOUBLE_EQ(s.high, 95);
  EXPECT_DOUBLE_EQ(s.largest, 100);
  EXPECT_DOUBLE_EQ(spread_of({1, 2}).high, 1.95);
  EXPECT_TRUE(std::isnan(spread_of({}).mean));
}

std::string message_of(std::vector<fs::path> const& files, EnvelopeOptions const& options) {
  try {
    measure_envelopes(files, options);
  } catch (InputError const& e) {
    std::string all;
    for (std::string const& p : e.problems) all += p + "\n";
    return all;
  }
  return "";
}

TEST_F(EnvelopeFiles, SaysWhatIsMissing) {
  auto const has = [](std::string const& text, char const* part) { return text.find(part) != std::string::npos; };
  Case c = flight(1);
  fs::path const good = run(c, "good");
  c.measure.clear();
  fs::path const plain = run(c, "plain");
  Simulation const s(c, {});
  {
    ResultsWriter writer(folder_ / "empty.h5", s.results_header());
    writer.finish({});
  }
  EXPECT_TRUE(has(message_of({plain}, {}), "no run_out measurement; name it with --direction"));
  EXPECT_EQ(message_of({plain}, {.direction = Vec3{1, 0, 0}}), "");
  EXPECT_TRUE(has(message_of({good}, {.direction = Vec3{0, 0, -2}}), "has no horizontal part"));
  EXPECT_TRUE(has(message_of({good}, {.direction = Vec3{0, 0, 0}}), "has no horizontal part"));
  EXPECT_TRUE(has(message_of({good}, {.bin = -1}), "bin -1"));
  EXPECT_TRUE(has(message_of({}, {}), "no results file"));
  // All problems at once.
  std::string const many = message_of({good, folder_ / "empty.h5", folder_ / "absent.h5", good}, {});
  EXPECT_TRUE(has(many, "empty.h5: has 0 frames"));
  EXPECT_TRUE(has(many, "absent.h5"));
  EXPECT_TRUE(has(many, "good.h5: is named twice"));
}

TEST_F(EnvelopeFiles, TablesHaveARowForEachThing) {
  Envelopes const e = measure_envelopes({run(flight(2), "tables")}, {.bin = 0.7});
  write_envelopes(e, folder_);
  EnvelopeGroup const& group = e.group[0];
  std::vector<std::size_t> const rows = {
      1, 2, group.bin.size(), group.cell.size(), group.screen.size(), group.moment.size()};
  std::vector<fs::path> const files = envelope_files(folder_);
  ASSERT_EQ(files.size(), rows.size());
  for (std::size_t k = 0; k < files.size(); ++k) {
    std::ifstream stream(files[k]);
    std::string line, head;
    std::getline(stream, head);
    auto const commas = [](std::string const& s) { return std::count(s.begin(), s.end(), ','); };
    std::size_t count = 0;
    while (std::getline(stream, line)) {
      ++count;
      EXPECT_EQ(commas(line), commas(head)) << files[k] << ": " << line;
    }
    EXPECT_EQ(count, rows[k]) << files[k];
  }
  EXPECT_THROW(write_envelopes(e, folder_ / "absent"), std::system_error);
}

}  // namespace
}  // namespace scree
