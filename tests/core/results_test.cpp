// results_test.cpp: the results file: what goes in comes out, damaged files are refused, killed runs are readable.
// SPDX-License-Identifier: Apache-2.0
#include "core/results.h"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <numbers>
#include <system_error>

#include "core/case.h"

namespace {

using namespace scree;
namespace fs = std::filesystem;

class ResultsFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_results_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    file_ = folder_ / "results.h5";
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_, file_;
};

Shape unit_sphere(std::string const& name) {
  Shape s;
  s.name = name;
  s.area = std::numbers::pi;
  double const inertia = s.volume / 10;  // 2/5 m r^2 at r = 1/2
  s.inertia = {inertia, inertia, inertia};
  s.bounding_radius = 0.5;
  s.box = {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
  return s;
}

ResultsHeader header(int n) {
  ResultsHeader h;
  h.case_text = "[case]\nname = \"t\"\n";
  h.shape_name = {"sphere/0", "a much longer sphere/1"};
  for (std::string const& name : h.shape_name) h.library.shape.push_back(unit_sphere(name));
  for (int i = 0; i < n; ++i) {
    h.shape.push_back(i % 2);
    h.diameter.push_back(0.1 + i);
    h.material.push_back(i % 3);
    h.group.push_back(i);
    h.replica.push_back(0);
  }
  h.wall = {{"floor", {0, 0, 1}, {0, 0, 1}}, {"side", {1, 2, 3}, {-1, 0, 0}}};
  h.ledger = {"applied"};
  h.domain = {{-1, -2, -3}, {4, 5, 6}};
  return h;
}

Frame frame(int n, int k) {
  Frame f;
  f.time = 0.1 * k;
  f.step = 1000 * k;
  for (int i = 0; i < n; ++i) {
    f.position.push_back({1.0 / (i + 1), k + 0.5, -i - 0.25});
    f.orientation.push_back(quat_from_rotation_vector({0.1 * i, 0.2 * k, 0.3}));
    f.velocity.push_back({1.0 * i, 2.0 * k, 3});
    f.spin.push_back({4.0 * k, 5, 6.0 * i});
  }
  return f;
}

void expect_same(Frame const& a, Frame const& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.orientation, b.orientation);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.spin, b.spin);
}

LedgerRow ledger_row(int k) { return {0.1 * k, 1.0 + k, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11e-20, 12.5, 2.25, 3.5}; }

void write_all(fs::path const& file, int n, int frames) {
  ResultsWriter writer(file, header(n));
  for (int k = 0; k < frames; ++k) {
    writer.write_frame(frame(n, k));
    writer.write_ledger(ledger_row(k));
  }
  writer.finish({{"bounds", 0.5, 10, 1000}, {"sdf_net", 1.5, 20, 123456789012}});
}

std::string refusal(fs::path const& file, bool recover = false) {
  try {
    ResultsReader const reader(file, recover);
  } catch (InputError const& error) {
    return error.what();
  }
  return "";
}

// Files from before columns had names: those of every run, and two more.
TEST_F(ResultsFile, OldLedgersAreRead) {
  fs::path const partial = file_.string() + ".partial";
  {
    ResultsHeader h = header(2);
    h.ledger = {"inserted", "global_damping"};
    ResultsWriter writer(file_, h);
    writer.write_frame(frame(2, 0));
    writer.write_ledger(ledger_row(1));
  }
  {
    hid_t const file = H5Fopen(partial.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    EXPECT_GE(H5Ldelete(file, "ledger_columns", H5P_DEFAULT), 0);
    H5Fclose(file);
  }
  std::vector<LedgerRow> const ledger = ResultsReader(partial, true).ledger();
  ASSERT_EQ(ledger.size(), 1u);
  EXPECT_EQ(ledger[0].inserted, 5);
  EXPECT_EQ(ledger[0].global_damping, 9);
  EXPECT_EQ(ledger[0].moved, 12.5);
  EXPECT_EQ(ledger[0].applied, 0);
}

TEST_F(ResultsFile, FramesSayWhichBodiesAreActiveWhereTheHeaderSaysSo) {
  ResultsHeader h = header(3);
  h.activity = true;
  Frame f = frame(3, 1);
  f.activity = {Activity::deleted, Activity::active, Activity::pending};
  {
    ResultsWriter writer(file_, h);
    writer.write_frame(f);
    Frame without = f;
    without.activity.clear();
    EXPECT_THROW(writer.write_frame(without), std::invalid_argument);
    writer.finish({});
  }
  ResultsReader const reader(file_);
  EXPECT_TRUE(reader.header().activity);
  EXPECT_EQ(reader.frame(0).activity, f.activity);
  EXPECT_TRUE(reader.frame(0).is_active(1));
  EXPECT_FALSE(reader.frame(0).is_active(0) || reader.frame(0).is_active(2));
  write_all(file_, 3, 1);
  EXPECT_FALSE(ResultsReader(file_).header().activity);
  EXPECT_TRUE(ResultsReader(file_).frame(0).activity.empty());
}

// A drum that turns, a sheet at rest and the disc of a cylinder's end.
ResultsHeader with_walls(int n) {
  ResultsHeader h = header(n);
  h.wall.push_back({"silo", {0, 0, 2}, {0, 0, -1}, 0.25});
  ResultsWallBody drum;
  drum.name = "drum";
  drum.kind = WallSolidKind::bore;
  drum.inside = drum.moving = true;
  drum.formula.kind = AnalyticKind::bore;
  drum.formula.half_size = {0.5, 0.5, 0.15};
  drum.position = {1, 2, 3};
  drum.orientation = quat_from_rotation_vector({0.1, 0.2, 0.3});
  ResultsWallBody funnel = drum;
  funnel.name = "funnel";
  funnel.kind = WallSolidKind::funnel;
  funnel.inside = funnel.moving = false;
  funnel.formula.kind = AnalyticKind::funnel;
  funnel.formula.half_wall = 0.02;
  ResultsWallBody sheet;
  sheet.name = "sheet";
  sheet.kind = WallSolidKind::sheet;
  sheet.half_wall = 0.01;
  sheet.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}, {1, 1, 0.5}}, {{0, 1, 2}, {2, 1, 3}}};
  ResultsWallBody lid = drum;
  lid.kind = WallSolidKind::plane;
  lid.formula.kind = AnalyticKind::plane;
  lid.mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  h.wall_body = {drum, funnel, sheet, lid};
  return h;
}

TEST_F(ResultsFile, WallBodiesAndTheirMotionComeBack) {
  ResultsHeader const h = with_walls(2);
  {
    ResultsWriter writer(file_, h);
    Frame f = frame(2, 3);
    EXPECT_THROW(writer.write_frame(f), std::invalid_argument) << "two walls move";
    f.wall_position = {{7, 8, 9}, {10, 11, 12}};
    f.wall_orientation = {{1, 0, 0, 0}, {0, 1, 0, 0}};
    writer.write_frame(f);
    writer.finish({});
  }
  ResultsReader const reader(file_);
  ASSERT_EQ(reader.header().wall.size(), 3u);
  EXPECT_EQ(reader.header().wall[0].radius, 0);
  EXPECT_EQ(reader.header().wall[2].radius, 0.25);
  ASSERT_EQ(reader.header().wall_body.size(), h.wall_body.size());
  for (std::size_t i = 0; i < h.wall_body.size(); ++i) {
    ResultsWallBody const &a = h.wall_body[i], &b = reader.header().wall_body[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.inside, b.inside);
    EXPECT_EQ(a.moving, b.moving);
    if (a.kind < WallSolidKind::mesh) {
      EXPECT_EQ(a.formula.kind, b.formula.kind);
      EXPECT_EQ(a.formula.half_size, b.formula.half_size);
      EXPECT_EQ(a.formula.half_wall, b.formula.half_wall);
    }
    EXPECT_EQ(a.half_wall, b.half_wall);
    EXPECT_EQ(a.mesh.vertex, b.mesh.vertex);
    EXPECT_EQ(a.mesh.triangle, b.mesh.triangle);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.orientation, b.orientation);
  }
  EXPECT_EQ(reader.frame(0).wall_position[1], (Vec3{10, 11, 12}));
  EXPECT_EQ(reader.frame(0).wall_orientation[1], (Quat{0, 1, 0, 0}));
}

// Files from before walls were bodies lack these objects, and so do files whose walls are planes at rest.
TEST_F(ResultsFile, WallsThatAreNotThereTakeNoObjects) {
  auto const has = [&](char const* name) {
    hid_t const file = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    bool const found = H5Lexists(file, name, H5P_DEFAULT) > 0;
    H5Fclose(file);
    return found;
  };
  write_all(file_, 2, 1);
  for (char const* name : {"wall_bodies", "walls/radius", "frames/wall_position", "frames/wall_orientation"})
    EXPECT_FALSE(has(name)) << name;
  EXPECT_TRUE(ResultsReader(file_).header().wall_body.empty());
  EXPECT_TRUE(ResultsReader(file_).frame(0).wall_position.empty());
  ResultsHeader still = with_walls(2);
  for (ResultsWallBody& w : still.wall_body) w.moving = false;
  {
    ResultsWriter writer(file_, still);
    writer.write_frame(frame(2, 0));
    writer.finish({});
  }
  EXPECT_TRUE(has("wall_bodies") && has("walls/radius"));
  EXPECT_FALSE(has("frames/wall_position") || has("frames/wall_orientation"));
  EXPECT_TRUE(ResultsReader(file_).frame(0).wall_position.empty());
}

TEST_F(ResultsFile, WhatGoesInComesOut) {
  int constexpr n = 3, frames = 4;
  write_all(file_, n, frames);
  ResultsReader const reader(file_);
  ResultsHeader const& h = reader.header();
  ResultsHeader const expected = header(n);
  EXPECT_EQ(h.case_text, expected.case_text);
  EXPECT_EQ(h.shape_name, expected.shape_name);
  ASSERT_EQ(h.library.shape.size(), 2u);
  EXPECT_EQ(h.library.shape[1].name, "a much longer sphere/1");
  EXPECT_EQ(h.library.shape[1].bounding_radius, 0.5);
  EXPECT_EQ(h.shape, expected.shape);
  EXPECT_EQ(h.diameter, expected.diameter);
  EXPECT_EQ(h.material, expected.material);
  EXPECT_EQ(h.group, expected.group);
  EXPECT_EQ(h.replica, expected.replica);
  ASSERT_EQ(h.wall.size(), 2u);
  EXPECT_EQ(h.wall[1].name, "side");
  EXPECT_EQ(h.wall[1].point, (Vec3{1, 2, 3}));
  EXPECT_EQ(h.wall[1].normal, (Vec3{-1, 0, 0}));
  EXPECT_EQ(h.domain.min, expected.domain.min);
  EXPECT_EQ(h.domain.max, expected.domain.max);
  ASSERT_EQ(reader.frames(), frames);
  for (int k = 0; k < frames; ++k) expect_same(reader.frame(k), frame(n, k));
  expect_same(reader.frame(-1), frame(n, frames - 1));
  std::vector<LedgerRow> const ledger = reader.ledger();
  ASSERT_EQ(ledger.size(), 4u);
  EXPECT_EQ(ledger[2].time, 0.1 * 2);
  EXPECT_EQ(ledger[2].kinetic, 3);
  EXPECT_EQ(ledger[2].residual, 11e-20);
  EXPECT_EQ(ledger[2].moved, 12.5);
  EXPECT_EQ(ledger[2].applied, 2.25);
  EXPECT_EQ(ledger[2].drag, 0);  // the header names no such column
  std::vector<StageRow> const stages = reader.stages();
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[1].name, "sdf_net");
  EXPECT_EQ(stages[1].seconds, 1.5);
  EXPECT_EQ(stages[1].items, 123456789012);
}

TEST_F(ResultsFile, NoBodiesAndNoFramesAreLegal) {
  {
    ResultsHeader empty;
    ResultsWriter writer(file_, empty);
    writer.write_frame({});
    writer.finish({});
  }
  ResultsReader const reader(file_);
  EXPECT_EQ(reader.frames(), 1);
  EXPECT_TRUE(reader.frame(0).position.empty());
  EXPECT_TRUE(reader.header().library.shape.empty());
  EXPECT_TRUE(reader.stages().empty());
}

TEST_F(ResultsFile, FrameOutOfRangeIsNamed) {
  write_all(file_, 1, 2);
  ResultsReader const reader(file_);
  EXPECT_THROW(reader.frame(2), InputError);
  EXPECT_THROW(reader.frame(-3), InputError);
}

TEST_F(ResultsFile, TruncatedAtAnyLengthIsRefused) {
  write_all(file_, 3, 2);
  std::uintmax_t const size = fs::file_size(file_);
  for (double const share : {0.0, 0.01, 0.3, 0.9, 0.999}) {
    fs::path const cut = folder_ / "cut.h5";
    fs::copy_file(file_, cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    EXPECT_NE(refusal(cut).find("cut.h5"), std::string::npos) << "accepted " << share << " of the file";
  }
}

TEST_F(ResultsFile, OneFlippedBitIsRefused) {
  write_all(file_, 3, 2);
  std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekg(-100, std::ios::end);
  char c = 0;
  stream.get(c);
  stream.seekp(-100, std::ios::end);
  stream.put(static_cast<char>(c ^ 1));
  stream.close();
  EXPECT_NE(refusal(file_).find("damaged"), std::string::npos);
}

TEST_F(ResultsFile, OtherFilesAreRefused) {
  std::ofstream(file_) << "not a results file at all";
  EXPECT_NE(refusal(file_).find("results.h5"), std::string::npos);
  EXPECT_NE(refusal(folder_ / "absent.h5").find("absent.h5"), std::string::npos);
}

TEST_F(ResultsFile, KilledRunIsReadableUpToItsLastFrame) {
  int constexpr n = 3, frames = 5;
  pid_t const child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ResultsWriter writer(file_, header(n));
    for (int k = 0; k < frames; ++k) {
      writer.write_ledger(ledger_row(k));
      writer.write_frame(frame(n, k));
    }
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_FALSE(fs::exists(file_)) << "an unfinished run must not look finished";
  EXPECT_NE(refusal(file_).find("did not finish"), std::string::npos);
  ResultsReader const reader(file_, true);
  ASSERT_EQ(reader.frames(), frames);
  expect_same(reader.frame(-1), frame(n, frames - 1));
  EXPECT_EQ(reader.ledger().size(), static_cast<std::size_t>(frames));
  EXPECT_EQ(reader.header().shape_name, header(n).shape_name);
}

TEST_F(ResultsFile, FinishedFileReplacesTheOldOneOnlyAtTheEnd) {
  write_all(file_, 2, 1);
  {
    ResultsWriter writer(file_, header(2));
    writer.write_frame(frame(2, 7));
    EXPECT_EQ(ResultsReader(file_).frame(0).step, 0);  // still the old file
    writer.finish({});
  }
  EXPECT_EQ(ResultsReader(file_).frame(0).step, 7000);
  EXPECT_FALSE(fs::exists(folder_ / "results.h5.partial"));
}

TEST_F(ResultsFile, UnwritablePlaceIsNamed) {
  std::ofstream(folder_ / "in_the_way") << "a file, not a folder";
  try {
    ResultsWriter const writer(folder_ / "in_the_way" / "results.h5", header(1));
    FAIL() << "wrote into a file as if it were a folder";
  } catch (std::system_error const& error) {
    EXPECT_NE(std::string(error.what()).find("in_the_way"), std::string::npos);
  }
}

TEST_F(ResultsFile, WrongLengthsAreRefused) {
  ResultsHeader bad = header(2);
  bad.diameter.pop_back();
  EXPECT_THROW(ResultsWriter(file_, bad), std::invalid_argument);
  ResultsWriter writer(file_, header(2));
  EXPECT_THROW(writer.write_frame(frame(3, 0)), std::invalid_argument);
}

}  // namespace
