// resume_cli_test.cpp: files of a run that was stopped, killed or prolonged equal those of one that was not.
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <thread>

#include "core/checkpoint_folder.h"
#include "core/results.h"
#include "tests/support/pouring_case.h"
#include "tests/support/same_state.h"
#include "tests/support/shell.h"

namespace {

using namespace scree;
using scree::testing::pouring_case;
namespace fs = std::filesystem;

// 0.2 s; the frames are not at multiples of the step.
std::string const pouring =
    pouring_case({.end = "0.2", .step = "5e-6", .rate = "100", .sampled = "0.0011", .every = "0.00703"});
std::string const scheduled = "[checkpoint]\nevery = 0.02\nkeep = 2\n";

std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class Resume : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_resume_test_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(std::string const& name, std::string const& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  int scree(std::string const& arguments, std::string* text = nullptr) const {
    auto const [code, said] = scree::testing::shell(folder_, SCREE_PROGRAM " " + arguments);
    if (text) *text = said;
    if (code != 0 && !text) printf("%s\n", said.c_str());
    return code;
  }

  // Starts `scree run` and sends it `signal` when ledger.csv of `out` has so many bytes. Exit code, or -signal.
  int run_and_signal(std::vector<std::string> const& arguments, fs::path const& out, std::uintmax_t bytes,
                     int signal) const {
    pid_t const child = ::fork();
    if (child == 0) {
      int const null = ::open("/dev/null", O_WRONLY);
      ::dup2(null, 1);
      ::dup2(null, 2);
      std::vector<char const*> argv{"scree", "run"};
      for (std::string const& a : arguments) argv.push_back(a.c_str());
      argv.push_back(nullptr);
      if (::chdir(folder_.c_str()) == 0) ::execv(SCREE_PROGRAM, const_cast<char**>(argv.data()));
      ::_exit(127);
    }
    std::error_code error;
    for (int i = 0; i < 20000; ++i) {
      std::uintmax_t const now = fs::file_size(folder_ / out / "ledger.csv", error);
      if (!error && now >= bytes) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  CheckpointFolder checkpoints(fs::path const& out) const { return CheckpointFolder(folder_ / out / "checkpoint"); }

  State last_state(fs::path const& out) const {
    std::vector<std::string> messages;
    return checkpoints(out).newest(messages)->state;
  }

  // Frames, ledger (also as text) and ParaView's files, to the last bit.
  void expect_same_files(fs::path const& a, fs::path const& b) const {
    for (char const* name : {"ledger.csv", "measures.csv", "contacts.csv"}) {
      EXPECT_GT(fs::file_size(folder_ / a / name), 100u) << name;
      EXPECT_TRUE(read_file(folder_ / a / name) == read_file(folder_ / b / name)) << name;
    }
    ResultsReader const x(folder_ / a / "results.h5"), y(folder_ / b / "results.h5");
    ASSERT_EQ(x.frames(), y.frames());
    auto const same = [](auto const& u, auto const& v) {
      return u.size() == v.size() && std::memcmp(u.data(), v.data(), u.size() * sizeof(u[0])) == 0;
    };
    for (int i = 0; i < x.frames(); ++i) {
      Frame const f = x.frame(i), g = y.frame(i);
      EXPECT_TRUE(f.time == g.time && f.step == g.step && same(f.position, g.position) &&
                  same(f.orientation, g.orientation) && same(f.velocity, g.velocity) && same(f.spin, g.spin) &&
                  same(f.activity, g.activity))
          << "frame " << i << " at t = " << f.time << " and " << g.time;
    }
    EXPECT_TRUE(same(x.ledger(), y.ledger()));
    ASSERT_EQ(x.measures().size(), y.measures().size());
    for (std::size_t i = 0; i < x.measures().size(); ++i) {
      MeasureSummary const m = x.measures()[i], n = y.measures()[i];
      EXPECT_TRUE(m.samples == n.samples && std::memcmp(&m.mean, &n.mean, 3 * sizeof(double)) == 0) << m.name;
    }
    Box const p = x.header().domain, q = y.header().domain;
    EXPECT_EQ(std::memcmp(&p, &q, sizeof(p)), 0);
    if (!fs::exists(folder_ / a / "paraview")) return;
    for (fs::directory_entry const& e : fs::recursive_directory_iterator(folder_ / a / "paraview"))
      if (e.is_regular_file()) {
        EXPECT_EQ(read_file(e.path()), read_file(folder_ / b / fs::relative(e.path(), folder_ / a))) << e.path();
      }
  }

  fs::path folder_;
};

TEST_F(Resume, AfterSigtermAndSigint) {
  write("pour.toml", pouring + scheduled);
  ASSERT_EQ(scree("run pour.toml -o whole"), 0);
  std::uintmax_t const bytes = fs::file_size(folder_ / "whole/ledger.csv");
  // Twice: a run can be stopped again after it was resumed.
  ASSERT_EQ(run_and_signal({"pour.toml", "-o", "stopped"}, "stopped", bytes / 4, SIGTERM), 130);
  EXPECT_GT(ResultsReader(folder_ / "stopped/results.h5").frames(), 3);
  EXPECT_LT(ResultsReader(folder_ / "stopped/results.h5").frames(), 28);
  EXPECT_FALSE(fs::exists(folder_ / "stopped/checkpoint/frames.log"));  // results.h5 has them
  ASSERT_EQ(run_and_signal({"pour.toml", "-o", "stopped", "--resume"}, "stopped", bytes / 2, SIGINT), 130);
  std::string said;
  ASSERT_EQ(scree("run pour.toml -o stopped --resume", &said), 0) << said;
  EXPECT_NE(said.find("goes on from t = "), std::string::npos) << said;
  expect_same_files("whole", "stopped");
  EXPECT_EQ(::scree::testing::differences(last_state("whole"), last_state("stopped")), "");
  EXPECT_LE(checkpoints("stopped").files().size(), 2u);
}

// No [checkpoint]: stopping writes one all the same, and nothing else does.
TEST_F(Resume, WithoutCheckpointsInTheCase) {
  write("pour.toml", pouring + "paraview = true\n");
  ASSERT_EQ(scree("run pour.toml -o whole"), 0);
  EXPECT_FALSE(fs::exists(folder_ / "whole/checkpoint"));
  ASSERT_EQ(run_and_signal({"pour.toml", "-o", "stopped"}, "stopped", fs::file_size(folder_ / "whole/ledger.csv") / 2,
                           SIGTERM),
            130);
  EXPECT_EQ(checkpoints("stopped").files().size(), 1u);
  ASSERT_EQ(scree("run pour.toml -o stopped --resume"), 0);
  expect_same_files("whole", "stopped");
}

// Killed outright, several times over: the run goes on from its last checkpoint, with the frames from before it.
TEST_F(Resume, AfterKills) {
  write("pour.toml", pouring + scheduled);
  ASSERT_EQ(scree("run pour.toml -o whole"), 0);
  std::uintmax_t const bytes = fs::file_size(folder_ / "whole/ledger.csv");
  ASSERT_EQ(run_and_signal({"pour.toml", "-o", "killed"}, "killed", bytes / 3, SIGKILL), -SIGKILL);
  EXPECT_FALSE(fs::exists(folder_ / "killed/results.h5"));
  EXPECT_FALSE(checkpoints("killed").files().empty());
  for (int const part : {4, 5, 6})
    ASSERT_EQ(run_and_signal({"pour.toml", "-o", "killed", "--resume"}, "killed", bytes * part / 10, SIGKILL),
              -SIGKILL);
  // The newest is damaged: an older one serves, and the run says so.
  ASSERT_EQ(checkpoints("killed").files().size(), 2u);
  fs::resize_file(checkpoints("killed").files().back(), 1000);
  std::string said;
  ASSERT_EQ(scree("run pour.toml -o killed --resume", &said), 0) << said;
  EXPECT_NE(said.find("passed by: "), std::string::npos) << said;
  expect_same_files("whole", "killed");
}

// A finished run with checkpoints goes on to a later end.
TEST_F(Resume, ToALaterEnd) {
  write("pour.toml", pouring + scheduled);
  ASSERT_EQ(scree("run pour.toml -o whole"), 0);
  ASSERT_EQ(scree("run pour.toml -o part --set time.end=0.1"), 0);
  ASSERT_EQ(scree("run pour.toml -o part --resume"), 0);
  expect_same_files("whole", "part");
  // At the end already: nothing is touched.
  auto const written = fs::last_write_time(folder_ / "part/ledger.csv");
  std::string said;
  ASSERT_EQ(scree("run pour.toml -o part --resume", &said), 0);
  EXPECT_NE(said.find("the run is finished, at t = 0.2 s"), std::string::npos) << said;
  EXPECT_TRUE(fs::last_write_time(folder_ / "part/ledger.csv") == written);
}

TEST_F(Resume, WhatCannotBeResumed) {
  write("pour.toml", pouring + scheduled);
  std::string said;
  // Nothing there yet: the same command starts the run.
  EXPECT_EQ(scree("run pour.toml -o out --resume --set time.end=0.03", &said), 0) << said;
  EXPECT_NE(said.find("no earlier run in out: starts at t = 0"), std::string::npos) << said;
  std::string const results = read_file(folder_ / "out/results.h5");
  EXPECT_EQ(scree("run pour.toml -o out --resume --force", &said), 2) << said;
  EXPECT_EQ(scree("run pour.toml -o out --resume --set contact.0.friction=0.6", &said), 2) << said;
  EXPECT_NE(said.find("friction = 0.5; this case has: [[contact]] friction = 0.6"), std::string::npos) << said;
  EXPECT_EQ(scree("run pour.toml -o out --resume --set time.end=0.01", &said), 2) << said;
  for (fs::path const& file : checkpoints("out").files()) fs::resize_file(file, 1000);
  EXPECT_EQ(scree("run pour.toml -o out --resume", &said), 2) << said;
  EXPECT_NE(said.find("no checkpoint here can be used; --force starts the run anew"), std::string::npos) << said;
  for (fs::path const& file : checkpoints("out").files()) fs::remove(file);
  EXPECT_EQ(scree("run pour.toml -o out --resume", &said), 2) << said;
  EXPECT_NE(said.find("a run wrote here, but no checkpoint"), std::string::npos) << said;
  EXPECT_EQ(read_file(folder_ / "out/results.h5"), results);  // all of it left the results alone
  // A checkpoint whose frames are gone.
  ASSERT_EQ(scree("run pour.toml -o out --force --set time.end=0.03"), 0);
  fs::remove(folder_ / "out/results.h5");
  EXPECT_EQ(scree("run pour.toml -o out --resume", &said), 2) << said;
  EXPECT_NE(said.find("frames, of which 0 are in"), std::string::npos) << said;
  ASSERT_EQ(scree("run pour.toml -o out --force --set time.end=0.01"), 0);
  EXPECT_EQ(checkpoints("out").files().size(), 1u);  // --force removed the old ones
}

// A watch that stops the run writes the state; a limit that lets it go on is one of the keys that may change.
TEST_F(Resume, AfterAWatchStop) {
  write("pour.toml", pouring);
  ASSERT_EQ(scree("run pour.toml -o whole"), 0);
  std::string said;
  ASSERT_EQ(scree("run pour.toml -o stopped --set limits.overlap=1e-4", &said), 1) << said;
  EXPECT_NE(said.find("stopped.h5"), std::string::npos) << said;
  EXPECT_GT(last_state("stopped").time, 0);
  ASSERT_EQ(scree("run pour.toml -o stopped --resume"), 0);
  expect_same_files("whole", "stopped");
}

}  // namespace
