// write_faults_test.cpp: every writer of a file against a full disk: names file and cause, leaves what was there.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>

#include "core/checkpoint_folder.h"
#include "core/frame_journal.h"
#include "core/png_file.h"
#include "core/simulation.h"
#include "core/vtk_file.h"
#include "shapes/analytic_shapes.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "shapes/point_files.h"
#include "tests/support/cases.h"
#include "tests/support/l_prism.h"
#include "tests/support/limited_disk.h"
#include "tests/support/same_state.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Case two_spheres() {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.4;
  c.time.step = 1e-4;
  c.time.end = 1;
  c.grains = {grains_at("sphere", {{0, 0, 0.0495}, {0.05, 0, 0.13}})};
  c.grains[0].evaluator = Evaluator::analytic;
  c.wall = {floor_at(0)};
  return c;
}

class WriteFaults : public ::testing::Test {
 protected:
  WriteFaults() : folder_(fs::temp_directory_path() / ("scree_write_faults_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~WriteFaults() override { fs::remove_all(folder_); }

  // `write` to this file with disks of every size up to what it takes: nothing half is ever there.
  void expect_whole_or_nothing(std::string const& name, std::function<void(fs::path const&)> const& write) {
    SCOPED_TRACE(name);
    fs::path const good = folder_ / ("good_" + name), file = folder_ / name;
    write(good);
    std::uintmax_t const size = fs::file_size(good);
    for (bool const replaces : {false, true}) {
      if (replaces) fs::copy_file(good, file);
      for (int k = 0; k < 12; ++k) {
        std::uintmax_t const room = k < 11 ? size * k / 11 : size - 1;
        std::string said;
        {
          FileSizeLimit const limit(room);
          try {
            write(file);
          } catch (std::runtime_error const& e) {
            said = e.what();
          }
        }
        EXPECT_EQ(said.find(file.string()), 0u) << said << " with " << room << " of " << size << " bytes";
        EXPECT_NE(said.find("File too large"), std::string::npos) << said;
        if (replaces) {
          EXPECT_TRUE(read_file(file) == read_file(good));
        } else {
          EXPECT_FALSE(fs::exists(file));
        }
      }
    }
    write(file);  // nothing that failed is in the way
    EXPECT_EQ(fs::file_size(file), size);
    fs::remove(good), fs::remove(file);
    EXPECT_TRUE(fs::is_empty(folder_)) << *fs::directory_iterator(folder_) << " was left behind";
  }

  fs::path folder_;
};

TEST_F(WriteFaults, ModelsMeshesPointsAndPictures) {
  Library library;
  for (char const* shape : {"sphere", "ellipsoid:1:0.8:0.6"}) library.shape.push_back(builtin_shape(shape));
  library.shape[0].name = "ball", library.shape[1].name = "egg";
  expect_whole_or_nothing("m.h5", [&](fs::path const& f) { write_model(f, library, true); });
  TriangleMesh const mesh = l_prism();
  for (char const* name : {"m.stl", "m.obj", "m.ply"})
    expect_whole_or_nothing(name, [&](fs::path const& f) { write_mesh(f, mesh); });
  for (char const* name : {"p.xyz", "p.ply"})
    expect_whole_or_nothing(name, [&](fs::path const& f) { write_points(f, {mesh.vertex, {}}); });
  expect_whole_or_nothing("p.png", [](fs::path const& f) { write_png(f, {16, 16, std::vector<std::uint8_t>(768)}); });
  expect_whole_or_nothing("p.vtp", [](fs::path const& f) { write_vtp(f, {}); });
}

TEST_F(WriteFaults, CheckpointsAndTheOneBeforeRestoresBitForBit) {
  Simulation s(two_spheres(), {});
  for (int i = 0; i < 300; ++i) s.step();
  Checkpoint const first = s.checkpoint();
  expect_whole_or_nothing("c.h5", [&](fs::path const& f) { write_checkpoint(f, first); });

  CheckpointFolder const checkpoints(folder_ / "checkpoint");
  std::uintmax_t const size = fs::file_size(checkpoints.write(first, 1));
  s.step();
  for (int k = 0; k < 12; ++k) {
    FileSizeLimit const limit(size * k / 12);
    EXPECT_THROW(checkpoints.write(s.checkpoint(), 1), std::system_error);
    std::vector<std::string> messages;
    auto const found = checkpoints.newest(messages);
    ASSERT_TRUE(found);
    EXPECT_TRUE(messages.empty());
    EXPECT_EQ(differences(found->state, first.state), "");
  }
  Simulation again(two_spheres(), {});
  std::vector<std::string> messages;
  again.restore(*checkpoints.newest(messages));
  again.step();
  EXPECT_EQ(differences(again.checkpoint().state, s.checkpoint().state), "");
}

// Results grow while the run goes: what was sealed stays, what is not sealed keeps its temporary name.
TEST_F(WriteFaults, Results) {
  Simulation s(two_spheres(), {});
  fs::path const file = folder_ / "results.h5";
  auto const write = [&](fs::path const& f) {
    ResultsWriter writer(f, s.results_header());
    for (int i = 0; i < 20; ++i) writer.write_ledger(s.ledger()), writer.write_frame(s.frame());
    writer.finish({});
  };
  write(file);
  std::string const before = read_file(file);
  for (int k = 0; k < 12; ++k) {
    FileSizeLimit const limit(before.size() * k / 12);
    try {
      write(file);
      ADD_FAILURE() << "nothing was refused";
    } catch (std::system_error const& e) {
      EXPECT_EQ(std::string(e.what()).find(file.string()), 0u) << e.what();
      EXPECT_NE(std::string(e.what()).find("File too large"), std::string::npos) << e.what();
    }
    EXPECT_TRUE(read_file(file) == before);
  }
  write(file);
  EXPECT_EQ(ResultsReader(file).frames(), 20);
}

// Records are there whole or not at all, and more can follow once there is room.
TEST_F(WriteFaults, Journal) {
  Simulation s(two_spheres(), {});
  fs::path const file = folder_ / "frames.log";
  auto const records = [&] {
    JournalReader reader(file);
    Frame frame;
    LedgerRow row;
    int count = 0;
    while (reader.next(frame, row)) ++count;
    EXPECT_EQ(reader.offset(), static_cast<std::int64_t>(fs::file_size(file)));
    return count;
  };
  JournalWriter writer(file, 0);
  writer.append(s.frame(), s.ledger());
  std::uintmax_t const record = fs::file_size(file);
  for (std::uintmax_t const room : {record, record + 10, record + 30, 2 * record - 1}) {
    FileSizeLimit const limit(room);
    EXPECT_THROW(writer.append(s.frame(), s.ledger()), std::system_error);
    EXPECT_EQ(records(), 1);
  }
  writer.append(s.frame(), s.ledger());
  EXPECT_EQ(records(), 2);
  EXPECT_THROW(JournalWriter(folder_ / "absent/frames.log", 0), std::system_error);
  EXPECT_THROW(JournalWriter(file, 1 << 30), std::system_error);  // what it should go on behind is not there
}

}  // namespace
}  // namespace scree
