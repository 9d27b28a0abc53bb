// full_disk_test.cpp: runs, pictures and exports on full, small, read-only and forbidden disks: a message with file and
// cause, no half file under its own name, and a run that goes on bit by bit once there is room.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "core/checkpoint_folder.h"
#include "core/results.h"
#include "tests/support/limited_disk.h"
#include "tests/support/pouring_case.h"
#include "tests/support/same_state.h"

namespace {

using namespace scree;
using namespace scree::testing;
namespace fs = std::filesystem;

// Every file that a run can write.
std::string const pouring =
    pouring_case({.end = "0.06", .step = "2e-5", .rate = "400", .sampled = "0.0003", .every = "0.00113"}) +
    "paraview = true\n[checkpoint]\nevery = 0.0061\nkeep = 2\n";

std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool says(Outcome const& outcome, std::string const& part) { return outcome.text.find(part) != std::string::npos; }

class FullDisk : public ::testing::Test {
 protected:
  // One run that had room, for all tests.
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("scree_full_disk_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "pour.toml") << pouring;
    Outcome const whole = scree("run pour.toml -o whole");
    ASSERT_EQ(whole.code, 0) << whole.text;
    for (auto const& e : fs::recursive_directory_iterator(folder_ / "whole")) {
      if (!e.is_regular_file()) continue;
      largest_ = std::max(largest_, e.file_size());
      all_ += (e.file_size() + 4095) / 4096 * 4096;
    }
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static Outcome scree(std::string const& arguments) {
    return shell(folder_, SCREE_PROGRAM " " + arguments + (arguments.starts_with("run") ? " --threads 1" : ""));
  }
  // The same while no file may grow beyond so many bytes.
  static Outcome limited(std::uintmax_t bytes, std::string const& arguments) {
    FileSizeLimit const limit(bytes);
    return scree(arguments);
  }
  static std::vector<fs::path> checkpoints(std::string const& out) {
    return CheckpointFolder(folder_ / out / "checkpoint").files();
  }

  // A run that ended for want of room: what is there under its own name is whole.
  static void expect_nothing_half(std::string const& out) {
    EXPECT_FALSE(fs::exists(folder_ / out / "results.h5"));
    EXPECT_FALSE(fs::exists(folder_ / out / "stages.json"));
    for (fs::path const& file : checkpoints(out)) EXPECT_NO_THROW(read_checkpoint(file)) << file;
    for (auto const& e : fs::recursive_directory_iterator(folder_ / out)) {
      std::string const name = e.path().filename(), text = e.is_regular_file() ? read_file(e.path()) : "";
      if (name.ends_with(".vtp") || name.ends_with(".pvd")) {
        EXPECT_TRUE(text.ends_with("</VTKFile>\n")) << e.path();
      }
      if (name.ends_with(".csv")) {
        EXPECT_TRUE(text.empty() || text.ends_with("\n")) << e.path();
      }
      bool const temporary =
          name.find(".partial-") != std::string::npos || (name.starts_with("step_") && name.ends_with(".partial"));
      EXPECT_FALSE(temporary) << e.path() << " was left behind";
    }
  }

  // With room it goes on where a checkpoint is, or starts anew; the files are those of the run that always had room.
  static void expect_resumes(std::string const& out) {
    Outcome const resumed = scree("run pour.toml -o " + out + (checkpoints(out).empty() ? " --force" : " --resume"));
    ASSERT_EQ(resumed.code, 0) << resumed.text;
    for (char const* name : {"ledger.csv", "measures.csv", "contacts.csv", "paraview/scene.pvd"})
      EXPECT_TRUE(read_file(folder_ / "whole" / name) == read_file(folder_ / out / name)) << name;
    EXPECT_EQ(ResultsReader(folder_ / out / "results.h5").frames(),
              ResultsReader(folder_ / "whole/results.h5").frames());
    ASSERT_FALSE(checkpoints(out).empty());
    EXPECT_EQ(
        differences(read_checkpoint(checkpoints("whole").back()).state, read_checkpoint(checkpoints(out).back()).state),
        "");
  }

  static inline fs::path folder_;
  static inline std::uintmax_t largest_ = 0, all_ = 0;  // of the whole run's files: the largest, all in blocks [bytes]
};

TEST_F(FullDisk, RunStopsAtAnyFileSizeAndGoesOn) {
  int with_checkpoint = 0;
  for (int part : {0, 1, 3, 5, 7, 9, 11}) {
    SCOPED_TRACE(part);
    std::string const out = "limited_" + std::to_string(part);
    Outcome const failed = limited(largest_ * part / 12 + 100, "run pour.toml -o " + out);
    EXPECT_EQ(failed.code, 4) << failed.text;
    EXPECT_TRUE(says(failed, "scree: error: " + out + "/")) << failed.text;
    EXPECT_TRUE(says(failed, "File too large")) << failed.text;
    expect_nothing_half(out);
    with_checkpoint += !checkpoints(out).empty();
    if (part % 4 == 1 || part == 0) expect_resumes(out);
  }
  EXPECT_GE(with_checkpoint, 3);
}

TEST_F(FullDisk, RunStopsOnASmallDiskAndGoesOn) {
  if (!can_mount()) GTEST_SKIP() << "no mount namespace: RLIMIT_FSIZE alone is tested";
  for (int part : {1, 4, 7}) {
    SCOPED_TRACE(part);
    std::string const out = "small_" + std::to_string(part);
    Outcome const failed =
        on_small_disk(folder_, "size=" + std::to_string(all_ * part / 10),
                      SCREE_PROGRAM " run pour.toml -o disk/out; code=$?; cp -r disk/out " + out + "; exit $code");
    EXPECT_EQ(failed.code, 4) << failed.text;
    EXPECT_TRUE(says(failed, "scree: error: disk/out")) << failed.text;
    EXPECT_TRUE(says(failed, "No space left on device")) << failed.text;
    expect_nothing_half(out);
    expect_resumes(out);
  }
}

// A run that cannot even go on leaves what it needs to go on later.
TEST_F(FullDisk, ResumingWithoutRoomLosesNothing) {
  EXPECT_EQ(limited(largest_ * 2 / 3, "run pour.toml -o out").code, 4);
  for (int part : {0, 2, 4}) {
    Outcome const again = limited(largest_ * part / 12 + 100, "run pour.toml -o out --resume");
    EXPECT_EQ(again.code, 4) << again.text;
    EXPECT_TRUE(says(again, "File too large")) << again.text;
    expect_nothing_half("out");
  }
  EXPECT_FALSE(checkpoints("out").empty());
  expect_resumes("out");
}

TEST_F(FullDisk, PicturesAndExportsAreWholeOrAbsent) {
  struct Export {
    std::string command, file;
  };
  for (Export const& e : {Export{"render whole/results.h5 --size 64x48 -o made.png", "made.png"},
                          Export{"export whole/results.h5 --stl -o made.stl --force", "made.stl"},
                          Export{"export whole/results.h5 --stl --format ply -o made.ply --force", "made.ply"},
                          Export{"export whole/results.h5 --stl --format obj -o made.obj --force", "made.obj"},
                          Export{"export whole/results.h5 -o made", "made/scene.pvd"}}) {
    SCOPED_TRACE(e.command);
    Outcome const failed = limited(300, e.command);
    EXPECT_EQ(failed.code, 4) << failed.text;
    EXPECT_TRUE(says(failed, "scree: error: made")) << failed.text;
    EXPECT_TRUE(says(failed, "File too large")) << failed.text;
    EXPECT_FALSE(fs::exists(folder_ / e.file));
    // An older one is left as it was.
    ASSERT_EQ(scree(e.command).code, 0);
    std::string const before = read_file(folder_ / e.file);
    EXPECT_EQ(limited(300, e.command).code, 4);
    EXPECT_TRUE(read_file(folder_ / e.file) == before);
  }
  for (auto const& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
}

// Through links, so that a program that replaces what it should write to destroys a link and not a device.
TEST_F(FullDisk, DevicesAreWrittenToNotReplaced) {
  std::string const draw = "render whole/results.h5 --size 64x48 -o ";
  fs::create_symlink("/dev/full", folder_ / "full.png");
  Outcome const picture = scree(draw + "full.png");
  EXPECT_EQ(picture.code, 4) << picture.text;
  EXPECT_TRUE(says(picture, "full.png: cannot be written: No space left on device")) << picture.text;
  EXPECT_TRUE(fs::is_symlink(folder_ / "full.png"));
  fs::create_symlink("/dev/null", folder_ / "null.png");
  EXPECT_EQ(scree(draw + "null.png").code, 0);
  EXPECT_TRUE(fs::is_character_file(folder_ / "null.png"));
  // What a link names is replaced, the link stays.
  std::ofstream(folder_ / "old.png") << "old";
  fs::create_symlink("old.png", folder_ / "link.png");
  EXPECT_EQ(scree(draw + "link.png").code, 0);
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.png"));
  EXPECT_EQ(read_file(folder_ / "old.png").substr(1, 3), "PNG");
}

TEST_F(FullDisk, StandardOutputThatTakesNothingIsAFailure) {
  for (char const* command : {"info whole/results.h5", "info whole/results.h5 --figures", "plan pour.toml"}) {
    Outcome const outcome = scree(std::string(command) + " > /dev/full");
    EXPECT_EQ(outcome.code, 4) << command << outcome.text;
    EXPECT_TRUE(says(outcome, "scree: error: standard output: cannot be written")) << outcome.text;
  }
  // A run is not given up for it: its files are whole.
  EXPECT_EQ(scree("run pour.toml -o deaf > /dev/full").code, 4);
  EXPECT_TRUE(read_file(folder_ / "deaf/ledger.csv") == read_file(folder_ / "whole/ledger.csv"));
  EXPECT_EQ(ResultsReader(folder_ / "deaf/results.h5").frames(), ResultsReader(folder_ / "whole/results.h5").frames());
}

TEST_F(FullDisk, ReadOnlyDisksAreNamed) {
  if (!can_mount()) GTEST_SKIP() << "no mount namespace: who runs this may write everywhere";
  auto const expect_named = [&](std::string const& command, std::string const& part) {
    Outcome const outcome = on_small_disk(
        folder_, "size=50m", "cp -r whole disk/out && mount -o remount,ro disk && " SCREE_PROGRAM " " + command);
    EXPECT_EQ(outcome.code, 4) << outcome.text;
    EXPECT_TRUE(says(outcome, part)) << outcome.text;
    EXPECT_TRUE(says(outcome, "Read-only file system")) << outcome.text;
  };
  expect_named("run pour.toml -o disk/new", "disk/new: the output folder cannot be made");
  expect_named("run pour.toml -o disk/out --resume --set time.end=0.07", "disk/out");
  expect_named("run pour.toml -o disk/out --force", "disk/out");
  expect_named("render disk/out/results.h5 --size 64x48 -o disk/x.png", "disk/x.png: cannot be written");
  expect_named("export disk/out/results.h5 --stl -o disk/x.stl", "disk/x.stl: cannot be written");
  expect_named("export disk/out/results.h5 --stl --per-grain -o disk/grains", "disk/grains");
}

TEST_F(FullDisk, PlacesThatCannotBeAreNamed) {
  std::ofstream(folder_ / "file") << "mine";
  fs::create_directories(folder_ / "folder.png");
  for (char const* place : {"absent/x.png", "file/x.png", "folder.png"}) {
    Outcome const picture = scree("render whole/results.h5 --size 64x48 -o " + std::string(place));
    EXPECT_EQ(picture.code, 4) << picture.text;
    EXPECT_TRUE(says(picture, std::string(place) + ": cannot be written: ")) << picture.text;
  }
  for (char const* arguments : {"--stl -o absent/x.stl", "--stl --per-grain -o file", "-o file"}) {
    Outcome const exported = scree("export whole/results.h5 " + std::string(arguments));
    EXPECT_EQ(exported.code, 4) << exported.text;
    EXPECT_TRUE(says(exported, "file") || says(exported, "absent/x.stl: cannot be written: ")) << exported.text;
  }
  EXPECT_EQ(read_file(folder_ / "file"), "mine");
  EXPECT_TRUE(fs::is_empty(folder_ / "folder.png"));
}

}  // namespace
