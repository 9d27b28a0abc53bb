// vtkhdf_test.cpp: the VTKHDF time series, read by the format's definition and, where VTK 9.3 or later is, by VTK.
// That is the Python module vtk of $SCREE_VTK_PYTHON or /usr/bin/python3 (Debian 12's is 9.1).
// SPDX-License-Identifier: Apache-2.0
#include "core/vtkhdf.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <system_error>

#include "core/results_hdf5.h"
#include "shapes/analytic_shapes.h"
#include "shapes/whole_file.h"

namespace {

using namespace scree;
namespace fs = std::filesystem;
using Numbers = std::vector<double>;
using results_hdf5::read_array;

ResultsHeader three_grains() {
  ResultsHeader h;
  for (char const* word : {"sphere", "box:1:1:2", "box:1:2:3"}) {
    h.library.shape.push_back(builtin_shape(word));
    h.shape_name.push_back(word);
  }
  h.shape = {2, 0, 1};
  h.diameter = {0.1, 0.2, 0.4};
  h.material = {0, 1, 0};
  h.group = {1, 1, 0};
  h.replica = {0, 0, 5};
  return h;
}

// Every number in it is another one; those of one tenth are no floats.
Frame frame_of(int k, std::vector<int> const& active) {
  Frame f;
  f.time = 0.1 * k;
  f.activity = {Activity::pending, Activity::pending, Activity::deleted};
  for (int const body : active) f.activity[static_cast<std::size_t>(body)] = Activity::active;
  for (int body = 0; body < 3; ++body) {
    double const at = k + 0.1 * body;
    f.position.push_back({at, at + 0.01, at + 0.02});
    f.orientation.push_back({at + 0.03, at + 0.04, at + 0.05, at + 0.06});
    f.velocity.push_back({-at, 10 + at, 20 + at});
    f.spin.push_back({30 + at, 40 + at, 50 + at});
  }
  return f;
}

// Bodies of the frames: none at first, between and last; the same in a row; some that come back.
std::vector<std::vector<int>> const active_in{{}, {1}, {1}, {}, {1}, {0, 1, 2}, {0, 1, 2}, {2}, {}, {0, 1}, {}};

// What a reader must find in a frame: arrays by name, a row a body that is active.
std::vector<std::pair<std::string, Numbers>> expected(int k) {
  ResultsHeader const h = three_grains();
  Frame const f = frame_of(k, active_in[static_cast<std::size_t>(k)]);
  Numbers position, orientation, velocity, spin, diameter, body, shape, kind, material, group, replica;
  for (int const b : active_in[static_cast<std::size_t>(k)]) {
    std::size_t const i = static_cast<std::size_t>(b);
    auto const append = [](Numbers& to, Vec3 const& v) { to.insert(to.end(), {v.x, v.y, v.z}); };
    append(position, f.position[i]);
    append(velocity, f.velocity[i]);
    append(spin, f.spin[i]);
    Quat const q = f.orientation[i];
    orientation.insert(orientation.end(), {q.w, q.x, q.y, q.z});
    diameter.push_back(h.diameter[i]);
    body.push_back(b);
    shape.push_back(h.shape[i]);
    kind.push_back(h.shape[i] > 0);  // both boxes are of one
    material.push_back(h.material[i]);
    group.push_back(h.group[i]);
    replica.push_back(h.replica[i]);
  }
  return {{"position", position}, {"orientation", orientation},
          {"velocity", velocity}, {"spin", spin},
          {"diameter", diameter}, {"body", body},
          {"shape", shape},       {"kind", kind},
          {"material", material}, {"group", group},
          {"replica", replica}};
}

// `count` rows of `width` numbers each from row `first` of a dataset.
Numbers rows_of(hid_t at, std::string const& name, std::int64_t first, std::int64_t count, std::int64_t width) {
  Numbers const all = width == 1 ? read_array<double>(at, name.c_str())
                                 : read_array<double>(at, name.c_str(), {static_cast<hsize_t>(width)});
  if (first < 0 || (first + count) * width > static_cast<std::int64_t>(all.size())) {
    ADD_FAILURE() << name << " is too short";
    return {};
  }
  return {all.begin() + first * width, all.begin() + (first + count) * width};
}

std::int64_t width_of(std::string const& name) {
  return name == "orientation" ? 4 : name == "position" || name == "velocity" || name == "spin" ? 3 : 1;
}

class Vtkhdf : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_vtkhdf_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    file_ = folder_ / "grains.vtkhdf";
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write() const {
    VtkhdfWriter writer(file_, three_grains());
    for (std::size_t k = 0; k < active_in.size(); ++k) writer.write_frame(frame_of(static_cast<int>(k), active_in[k]));
    writer.finish();
  }
  fs::path folder_, file_;
};

TEST_F(Vtkhdf, HoldsEveryFrameByTheFormatsDefinition) {
  write();
  EXPECT_EQ(read_whole_file(file_).substr(0, 8), "\x89HDF\r\n\x1a\n");
  hdf5::Handle const file = hdf5::open_file(file_.string()), root = hdf5::open_group(file, "/VTKHDF");
  EXPECT_EQ(hdf5::read_string(root, "Type"), "PolyData");
  hdf5::Handle const steps = hdf5::open_group(root, "Steps"), fields = hdf5::open_group(steps, "PointDataOffsets"),
                     data = hdf5::open_group(root, "PointData"), vertices = hdf5::open_group(root, "Vertices");
  EXPECT_EQ(hdf5::read_integer(steps, "NSteps"), static_cast<std::int64_t>(active_in.size()));
  auto const time = read_array<double>(steps, "Values");
  auto const points = read_array<std::int64_t>(root, "NumberOfPoints");
  auto const part = read_array<std::int64_t>(steps, "PartOffsets");
  auto const parts = read_array<std::int64_t>(steps, "NumberOfParts");
  auto const first = read_array<std::int64_t>(steps, "PointOffsets");
  auto const cell = read_array<std::int64_t>(steps, "CellOffsets", {4});
  auto const id = read_array<std::int64_t>(steps, "ConnectivityIdOffsets", {4});
  for (std::size_t k = 0; k < active_in.size(); ++k) {
    SCOPED_TRACE(k);
    std::int64_t const n = static_cast<std::int64_t>(active_in[k].size());
    EXPECT_EQ(time.at(k), 0.1 * static_cast<double>(k));
    EXPECT_EQ(parts.at(k), 1);
    ASSERT_EQ(points.at(static_cast<std::size_t>(part.at(k))), n);
    for (auto const& [name, value] : expected(static_cast<int>(k)))
      EXPECT_EQ(rows_of(data, name, read_array<std::int64_t>(fields, name.c_str()).at(k), n, width_of(name)), value)
          << name;
    EXPECT_EQ(rows_of(root, "Points", first.at(k), n, 3), expected(static_cast<int>(k))[0].second);
    Numbers count;
    for (int i = 0; i <= n; ++i) count.push_back(i);
    EXPECT_EQ(rows_of(vertices, "Offsets", cell.at(4 * k) + part[k], n + 1, 1), count);  // each part has one more
    count.pop_back();
    EXPECT_EQ(rows_of(vertices, "Connectivity", id.at(4 * k), n, 1), count);
    for (char const* none : {"Lines", "Polygons", "Strips"}) {
      hdf5::Handle const topology = hdf5::open_group(root, none);
      EXPECT_EQ(rows_of(topology, "NumberOfCells", part[k], 1, 1), Numbers{0});
      EXPECT_EQ(rows_of(topology, "NumberOfConnectivityIds", part[k], 1, 1), Numbers{0});
      EXPECT_EQ(rows_of(topology, "Offsets", part[k], 1, 1), Numbers{0});
    }
  }
}

TEST_F(Vtkhdf, StoresWhatDoesNotMoveOnceForFramesOfTheSameBodies) {
  write();
  hdf5::Handle const file = hdf5::open_file(file_.string());
  // {1} of three frames, with none between; {0, 1, 2} of two; {2}; {0, 1}; and the part of the empty ones, the last.
  EXPECT_EQ(read_array<std::int64_t>(file, "VTKHDF/NumberOfPoints"), (std::vector<std::int64_t>{1, 3, 1, 2, 0}));
  EXPECT_EQ(read_array<std::int64_t>(file, "VTKHDF/Steps/PartOffsets"),
            (std::vector<std::int64_t>{4, 0, 0, 4, 0, 1, 1, 2, 4, 3, 4}));
  EXPECT_EQ(read_array<double>(file, "VTKHDF/PointData/diameter").size(), 1u + 3 + 1 + 2);
  EXPECT_EQ(read_array<double>(file, "VTKHDF/Points", {3}).size(), 3u * (3 * 1 + 2 * 3 + 1 + 2));
}

TEST_F(Vtkhdf, FramesWithoutActivityHaveAllBodies) {
  VtkhdfWriter writer(file_, three_grains());
  Frame frame = frame_of(0, {});
  frame.activity.clear();
  for (int k = 0; k < 2; ++k) writer.write_frame(frame);
  writer.finish();
  hdf5::Handle const file = hdf5::open_file(file_.string());
  EXPECT_EQ(read_array<std::int64_t>(file, "VTKHDF/NumberOfPoints"), std::vector<std::int64_t>{3});
  EXPECT_EQ(read_array<std::int64_t>(file, "VTKHDF/Steps/PointOffsets"), (std::vector<std::int64_t>{0, 3}));
}

TEST_F(Vtkhdf, ReplacesWhatWasThereOnlyWhenItIsDone) {
  write_whole_file(file_, "before", true);
  {
    VtkhdfWriter writer(file_, three_grains());
    writer.write_frame(frame_of(0, {0}));
  }
  EXPECT_EQ(read_whole_file(file_), "before");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  write();
  EXPECT_NE(read_whole_file(file_), "before");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(Vtkhdf, SaysWhichFileCannotBeWritten) {
  fs::path const nowhere = folder_ / "nowhere" / "grains.vtkhdf";
  try {
    VtkhdfWriter writer(nowhere, three_grains());
    ADD_FAILURE() << "no exception";
  } catch (std::system_error const& e) {
    EXPECT_NE(std::string(e.what()).find(nowhere.string()), std::string::npos) << e.what();
    EXPECT_EQ(e.code().value(), ENOENT);
  }
}

TEST_F(Vtkhdf, VtkReadsEveryFrame) {
  write();
  char const* const chosen = std::getenv("SCREE_VTK_PYTHON");
  fs::path const said = folder_ / "said.txt";
  std::string const command = std::string("'") + (chosen ? chosen : "/usr/bin/python3") +
                              "' '" SCREE_SOURCE_DIR "/tests/core/vtkhdf_read.py' '" + file_.string() + "' '" +
                              folder_.string() + "' > '" + said.string() + "' 2>&1";
  int const status = std::system(command.c_str());
  int const exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (exit_code == 77 || exit_code == 127)
    GTEST_SKIP() << "no VTK 9.3 or later: set SCREE_VTK_PYTHON to a Python that has it";
  ASSERT_EQ(exit_code, 0) << read_whole_file(said);
  EXPECT_EQ(read_whole_file(said), "");  // VTK complains there and goes on
  auto const found = [&](std::string const& name) {
    std::string const bytes = read_whole_file(folder_ / name);
    Numbers value(bytes.size() / sizeof(double));
    if (!value.empty()) std::memcpy(value.data(), bytes.data(), bytes.size());
    return value;
  };
  ASSERT_EQ(found("time").size(), active_in.size());
  for (std::size_t k = 0; k < active_in.size(); ++k) {
    SCOPED_TRACE(k);
    std::string const step = std::to_string(k) + ".";
    EXPECT_EQ(found("time")[k], 0.1 * static_cast<double>(k));
    Numbers cells;
    for (std::size_t i = 0; i < active_in[k].size(); ++i) cells.insert(cells.end(), {1, static_cast<double>(i)});
    EXPECT_EQ(found(step + "cells"), cells);
    EXPECT_EQ(found(step + "points"), expected(static_cast<int>(k))[0].second);
    for (auto const& [name, value] : expected(static_cast<int>(k))) {
      if (value.empty() && !fs::exists(folder_ / (step + name))) continue;  // VTK 9.3 gives an empty frame no arrays
      EXPECT_EQ(found(step + name), value) << name;
    }
  }
}

}  // namespace
