// checkpoint_test.cpp: the file of a checkpoint: killed writers, damaged files, other versions and cases, the last N.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "core/case_identity.h"
#include "core/checkpoint_folder.h"
#include "core/frame_journal.h"
#include "core/simulation_impl.h"
#include "shapes/file_container.h"
#include "tests/support/every_effect.h"
#include "tests/support/same_state.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
void write_file(fs::path const& file, std::string const& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

// Two spheres and an egg on a floor. Without damping, whose ratio takes a third of a second to look up.
Case small_case() {
  Case c = sticky_case(ContactLaw::winkler);
  c.contact[0].damping_ratio.reset();
  GrainsCase egg = grains_at("ellipsoid:1:0.8:0.6", {{0.2, 0, 0.038}}, 0.1, 120);
  egg.name = "egg";
  c.grains = {grains_at("sphere", {{0, 0, 0.0495}, {0.05, 0, 0.13}}, 0.1, 120), egg};
  for (GrainsCase& g : c.grains) g.evaluator = Evaluator::analytic;
  c.wall = {floor_at(0)};
  return c;
}

class CheckpointFile : public ::testing::Test {
 protected:
  CheckpointFile() : folder(fs::temp_directory_path() / ("scree_checkpoint_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
    file = folder / "c.h5";
  }
  ~CheckpointFile() override { fs::remove_all(folder); }

  static void advance(Simulation& s, int steps) {
    for (int i = 0; i < steps; ++i) s.step();
  }
  void write_one(Case const& c) const {
    Simulation s(c, {});
    advance(s, 50);
    write_checkpoint(file, s.checkpoint());
  }
  // Reading must fail with one message that names the file and says `part`.
  static std::string refusal(fs::path const& file) {
    try {
      read_checkpoint(file);
    } catch (InputError const& e) {
      EXPECT_EQ(e.problems.size(), 1u);
      EXPECT_NE(std::string(e.what()).find(file.filename().string()), std::string::npos) << e.what();
      return e.what();
    }
    ADD_FAILURE() << "it was read";
    return {};
  }
  static std::string refusal(Case const& c, Checkpoint const& checkpoint) {
    Simulation s(c, {});
    try {
      s.restore(checkpoint);
    } catch (InputError const& e) {
      return e.what();
    }
    return {};
  }
  static void expect_says(std::string const& text, std::string const& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks: " << part;
  }

  fs::path folder, file;
};

TEST_F(CheckpointFile, HoldsEveryMember) {
  Simulation s(small_case(), {});
  advance(s, 50);
  Checkpoint const out = s.checkpoint();
  write_checkpoint(file, out);
  Checkpoint const in = read_checkpoint(file);
  EXPECT_EQ(differences(out.state, in.state), "");
  EXPECT_EQ(in.identity, out.identity);
  EXPECT_EQ(in.inputs, out.inputs);
  EXPECT_TRUE(std::equal(in.pairs.pair.begin(), in.pairs.pair.end(), out.pairs.pair.begin(), out.pairs.pair.end()));
  EXPECT_GE(in.pairs.pair.size(), 3u);
  EXPECT_EQ(in.pairs.side, out.pairs.side);
  EXPECT_FALSE(in.pairs.side.empty());
  EXPECT_FALSE(fs::exists(file.string() + ".partial"));
}

// Killed 50 times while it writes, the last good one always restores.
TEST_F(CheckpointFile, KilledWriterLeavesAGoodOne) {
  Case c = small_case();
  c.grains.pop_back();  // the egg's nodes take long to make
  CheckpointFolder const checkpoints(folder / "checkpoint");
  std::mt19937 random(1);
  int restored = 0, torn = 0;
  std::int64_t step = 0;
  for (int kill = 0; kill < 50; ++kill) {
    pid_t const child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      try {  // writes one after every step, for ever
        Simulation s(c, {});
        std::vector<std::string> messages;
        if (auto const found = checkpoints.newest(messages)) s.restore(*found);
        for (;;) {
          s.impl().run_state = RunState::running;
          s.step();
          checkpoints.write(s.checkpoint(), 2);
        }
      } catch (...) {
        ::_exit(1);
      }
    }
    // Once the child is at work, at a random moment within several writes.
    auto const number = [&] {
      return checkpoints.files().empty() ? -1 : std::stoll(checkpoints.files().back().stem().string().substr(5));
    };
    for (int i = 0; i < 5000 && number() <= step; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the writer failed by itself";
    for (fs::directory_entry const& e : fs::directory_iterator(folder / "checkpoint"))
      torn += e.path().extension() == ".partial";
    std::vector<std::string> messages;
    std::optional<Checkpoint> const found = checkpoints.newest(messages);
    ASSERT_TRUE(found);
    EXPECT_TRUE(messages.empty()) << messages[0];  // a file under its own name is whole
    EXPECT_GT(found->state.step, step);
    step = found->state.step;
    Simulation s(c, {});
    s.restore(*found);
    EXPECT_EQ(s.steps(), step);
    ++restored;
  }
  EXPECT_EQ(restored, 50);
  EXPECT_GT(torn, 0);  // some were killed in the middle
  // Writers that were killed before they removed the oldest leave more than two; the next one makes up for it.
  Simulation s(c, {});
  std::vector<std::string> messages;
  s.restore(*checkpoints.newest(messages));
  checkpoints.write(s.checkpoint(), 2);
  EXPECT_EQ(checkpoints.files().size(), 2u);
  printf("50 kills, %d in the middle of a file, %lld checkpoints\n", torn, static_cast<long long>(step));
}

TEST_F(CheckpointFile, DamagedFilesAreRefused) {
  write_one(small_case());
  std::string const good = read_file(file);
  fs::path const bad = folder / "bad.h5";
  for (std::size_t const length : {std::size_t{0}, std::size_t{10}, std::size_t{300}, std::size_t{512},
                                   std::size_t{600}, good.size() / 2, good.size() - 1}) {
    write_file(bad, good.substr(0, length));
    refusal(bad);
  }
  write_file(bad, good + "x");
  refusal(bad);
  std::mt19937 random(2);
  for (int i = 0; i < 400; ++i) {
    std::string flipped = good;
    // The zeros behind the fields of the user block are checked, too.
    std::size_t const at = i < 100 ? i * 512 / 100 : random() % good.size();
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (i % 8)));
    write_file(bad, flipped);
    refusal(bad);
  }
  expect_says(refusal(folder / "absent.h5"), "no such file");
}

TEST_F(CheckpointFile, OtherVersionsAndKindsAreNamed) {
  write_one(small_case());
  fs::copy_file(file, folder / "payload");
  seal_container(folder / "payload", folder / "newer.h5", "scree.checkpoint", checkpoint_version + 1);
  expect_says(refusal(folder / "newer.h5"),
              "has format version " + std::to_string(checkpoint_version + 1) + ", this program reads up to ");
  fs::copy_file(file, folder / "payload");
  seal_container(folder / "payload", folder / "results.h5", "scree.results", 1);
  expect_says(refusal(folder / "results.h5"), "is a \"scree.results\" file; a \"scree.checkpoint\" file is needed");
  // A sound file that lacks a member, as one of an older program would.
  fs::copy_file(file, folder / "payload");
  hid_t const open = H5Fopen((folder / "payload").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(open, 0);
  ASSERT_GE(H5Ldelete(open, "/state/work_friction", H5P_DEFAULT), 0);
  H5Fclose(open);
  seal_container(folder / "payload", folder / "older.h5", "scree.checkpoint", checkpoint_version);
  expect_says(refusal(folder / "older.h5"), "dataset 'work_friction' is missing");
}

TEST_F(CheckpointFile, AnotherCaseIsRefusedWithTheDifference) {
  Case const c = small_case();
  write_one(c);
  Checkpoint const checkpoint = read_checkpoint(file);
  EXPECT_EQ(refusal(c, checkpoint), "");
  Case other = c;
  other.contact[0].friction = 0.7;
  expect_says(refusal(other, checkpoint), "[[contact]] friction = 0.4; this case has: [[contact]] friction = 0.7");
  other = c;
  other.grains[1].insert.position.push_back({0.5, 0, 0.06});
  other.grains[1].count = 2;
  expect_says(refusal(other, checkpoint), "is of another case");
  // What may change.
  other = c;
  other.time.end = 3;
  other.output = {0.5, true};
  other.checkpoint = CheckpointCase{0.1, 7};
  other.limits.overlap = 0.4;
  EXPECT_EQ(refusal(other, checkpoint), "");
  other.time.end = 0.001;
  expect_says(refusal(other, checkpoint), "after time.end = 0.001 s");
}

// The same case over a library whose shape has changed under its name; moving the library changes nothing.
TEST_F(CheckpointFile, OtherShapesUnderTheSameNamesAreRefused) {
  Case c = small_case();
  Library library = certified_pebbles();
  write_model(folder / "pebbles.h5", library, true);
  c.library = {{"pebbles", folder / "pebbles.h5"}};
  c.grains[1].shapes = {"pebbles:flat/0"};
  c.grains[1].evaluator = Evaluator::net;
  write_one(c);
  Checkpoint const checkpoint = read_checkpoint(file);
  fs::create_directories(folder / "elsewhere");
  fs::rename(folder / "pebbles.h5", folder / "elsewhere/pebbles.h5");
  c.library[0].file = folder / "elsewhere/pebbles.h5";
  EXPECT_EQ(refusal(c, checkpoint), "");
  library.net[0].bias[1][0] *= 1 + 1e-5f;
  write_model(c.library[0].file, library, true);
  expect_says(refusal(c, checkpoint), "is of other files");
}

// Sound containers with content that no run has written.
TEST_F(CheckpointFile, ContradictoryContentIsRefused) {
  Case const c = small_case();
  write_one(c);
  Checkpoint const good = read_checkpoint(file);
  ASSERT_EQ(refusal(c, good), "");
  auto const broken = [&](auto const& breaking) {
    Checkpoint bad = good;
    breaking(bad);
    std::string const text = refusal(c, bad);
    EXPECT_NE(text, "");
    return text;
  };
  expect_says(broken([](Checkpoint& k) { k.state.position.pop_back(); }), "'position' has 2 entries");
  broken([](Checkpoint& k) { k.pairs.pair[0].a = 99; });
  broken([](Checkpoint& k) { k.pairs.pair[0].b = -7; });
  broken([](Checkpoint& k) { k.pairs.overlap.pop_back(); });
  broken([](Checkpoint& k) { k.pairs.built_position.pop_back(); });
  broken([](Checkpoint& k) { k.pairs.side[0] = 1 << 30; });
  broken([](Checkpoint& k) { k.state.node_history.first[0] = 1 << 30; });
  broken([](Checkpoint& k) { k.state.rolling_history.angle.pop_back(); });
  broken([](Checkpoint& k) { k.state.wrench.rolling.pop_back(); });
  expect_says(broken([](Checkpoint& k) { k.state.velocity[1].y = std::nan(""); }), "not finite");
}

TEST_F(CheckpointFile, TheLastNAreKept) {
  Simulation s(small_case(), {});
  CheckpointFolder const checkpoints(folder / "checkpoint");
  fs::create_directories(folder / "checkpoint");
  write_file(folder / "checkpoint/notes.txt", "mine");
  for (int i = 0; i < 6; ++i) {
    s.step();
    checkpoints.write(s.checkpoint(), 3);
    EXPECT_EQ(checkpoints.files().size(), std::size_t(std::min(i + 1, 3)));
  }
  EXPECT_EQ(checkpoints.files().front().filename(), "step_000000000004.h5");
  EXPECT_EQ(checkpoints.files().back().filename(), "step_000000000006.h5");
  checkpoints.remove_all();
  EXPECT_TRUE(checkpoints.files().empty());
  EXPECT_EQ(read_file(folder / "checkpoint/notes.txt"), "mine");
}

TEST_F(CheckpointFile, DamagedNewestIsPassedBy) {
  Simulation s(small_case(), {});
  CheckpointFolder const checkpoints(folder / "checkpoint");
  std::vector<std::string> messages;
  EXPECT_FALSE(checkpoints.newest(messages));  // none at all
  for (int i = 0; i < 3; ++i) s.step(), checkpoints.write(s.checkpoint(), 3);
  std::string bytes = read_file(checkpoints.files()[2]);
  bytes[2000] ^= 1;
  write_file(checkpoints.files()[2], bytes);
  fs::resize_file(checkpoints.files()[1], 700);
  std::optional<Checkpoint> const found = checkpoints.newest(messages);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->state.step, 1);
  ASSERT_EQ(messages.size(), 2u);
  expect_says(messages[0], "step_000000000003.h5: is damaged");
  expect_says(messages[1], "step_000000000002.h5: is cut short");
  fs::resize_file(checkpoints.files()[0], 0);
  try {
    checkpoints.newest(messages);
    FAIL() << "nothing was refused";
  } catch (InputError const& e) {
    EXPECT_EQ(e.problems.size(), 4u);  // three reasons and the way out
    expect_says(e.what(), "--force");
  }
}

// Poses of moving walls come back with the frame, and a drum's bore and ends are all there.
TEST_F(CheckpointFile, JournalHoldsThePosesOfMovingWalls) {
  Simulation s(spheres_in_a_drum(), {});
  for (int i = 0; i < 5; ++i) s.step();
  Frame const written = s.frame();
  ASSERT_EQ(written.wall_position.size(), 3u);  // bore and one end of the drum, the sliding plane
  fs::path const journal = folder / "frames.log";
  JournalWriter(journal, 0).append(written, s.ledger());
  JournalReader reader(journal);
  Frame read;
  LedgerRow row;
  ASSERT_TRUE(reader.next(read, row));
  EXPECT_EQ(read.wall_position, written.wall_position);
  EXPECT_EQ(read.wall_orientation, written.wall_orientation);
  EXPECT_NE(read.wall_orientation[0], s.results_header().wall_body[0].orientation);
}

// Any cut through the journal loses the frame that is cut and nothing before it.
TEST_F(CheckpointFile, TornJournalKeepsItsWholeRecords) {
  Simulation s(small_case(), {});
  fs::path const journal = folder / "frames.log";
  std::vector<std::size_t> end;
  std::vector<Frame> frames;
  {
    JournalWriter writer(journal, 0);
    for (int i = 0; i < 3; ++i) {
      s.step();
      frames.push_back(s.frame());
      writer.append(s.frame(), s.ledger());
      end.push_back(fs::file_size(journal));
    }
    writer.sync();
  }
  std::string const whole = read_file(journal);
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    std::size_t const cut = random() % whole.size();
    write_file(journal, whole.substr(0, cut) + (i % 2 ? std::string(50, '\x5a') : ""));
    JournalReader reader(journal);
    Frame frame;
    LedgerRow row;
    std::size_t count = 0;
    while (reader.next(frame, row)) {
      EXPECT_EQ(frame.position.at(1).z, frames.at(count).position.at(1).z);
      ++count;
    }
    EXPECT_EQ(count, std::size_t(std::count_if(end.begin(), end.end(), [&](std::size_t e) { return e <= cut; })));
    EXPECT_EQ(reader.offset(), count == 0 ? 0 : static_cast<std::int64_t>(end[count - 1]));
  }
}

}  // namespace
}  // namespace scree
