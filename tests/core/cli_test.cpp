// cli_test.cpp: the scree program as its users meet it: exit codes, messages, and nothing overwritten on bad input.
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

#include "core/case.h"
#include "core/results.h"
#include "kernels/base/device.h"
#include "shapes/file_container.h"
#include "tests/core/program_fixture.h"

namespace scree {
namespace {

using namespace testing;

TEST_F(Program, RunsAndSealsItsFiles) {
  write("small.toml", small_case);
  Outcome const outcome = scree("run small.toml --threads 1");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("particle-steps/s"), std::string::npos);
  EXPECT_NE(outcome.text.find("energy ledger"), std::string::npos);
  fs::path const out = folder_ / "small.out";
  ResultsReader const results(out / "results.h5");
  EXPECT_EQ(results.frames(), 3);  // t = 0, 1 and 2 ms
  // 1 mm of free fall at 1 m/s and more ends in the floor's reach: the fall of the first ms is v t + g t^2 / 2.
  EXPECT_NEAR(results.frame(1).position.at(0).z, 0.051 - 1e-3 - 9.81e-6 / 2, 1e-12);
  EXPECT_EQ(results.ledger().size(), 3u);
  EXPECT_FALSE(results.stages().empty());
  EXPECT_EQ(load_case(out / "case.effective.toml", {}).grains.at(0).name, "one");
  for (char const* name : {"ledger.csv", "stages.json", "run.log"}) EXPECT_GT(fs::file_size(out / name), 0u) << name;
  EXPECT_FALSE(fs::exists(out / "results.h5.partial"));
  EXPECT_FALSE(fs::exists(out / "paraview"));
  EXPECT_EQ(outcome.text.find("queries"), std::string::npos);  // balls ask nobody
  EXPECT_EQ(scree("info small.out/results.h5").code, 0);
}

TEST_F(Program, TellsWhichQueriesItMadeAndWhichNot) {
  write("small.toml", small_case);
  Outcome const outcome = scree("run small.toml --set 'grains.one.shapes=[\"ellipsoid:1:0.8:0.6\"]'");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  for (char const* words : {"queries   ", "left out  "})
    EXPECT_NE(outcome.text.find(words), std::string::npos) << outcome.text;
  std::ifstream const file(folder_ / "small.out/stages.json");
  std::stringstream text;
  text << file.rdbuf();
  for (char const* key : {"\"queries\": {\"nodes\": ", "\"peak_flop_per_second\": "})
    EXPECT_NE(text.str().find(key), std::string::npos) << text.str();
}

TEST_F(Program, OverridesReachTheRun) {
  write("small.toml", small_case);
  Outcome const outcome = scree("run small.toml --set time.end=0.001 --set output.paraview=true");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(ResultsReader(folder_ / "small.out/results.h5").frames(), 2);
  EXPECT_TRUE(fs::exists(folder_ / "small.out/paraview/scene.pvd"));
  fs::remove_all(folder_ / "small.out/paraview");
  EXPECT_EQ(scree("export small.out/results.h5").code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "small.out/paraview/scene.pvd"));
}

TEST_F(Program, PlanAndCheckTouchNothing) {
  write("small.toml", small_case);
  Outcome const plan = scree("plan small.toml");
  EXPECT_EQ(plan.code, 0) << plan.text;
  EXPECT_NE(plan.text.find("sphere_contacts"), std::string::npos) << plan.text;
  EXPECT_EQ(scree("check small.toml").code, 0);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(Program, UsageErrorsAreBadInput) {
  EXPECT_EQ(scree("").code, 2);
  EXPECT_EQ(scree("fly").code, 2);
  EXPECT_EQ(scree("run").code, 2);
  EXPECT_EQ(scree("run x.toml --threads 0").code, 2);
  EXPECT_EQ(scree("--help").code, 0);
  EXPECT_EQ(scree("run --help").code, 0);
  Outcome const version = scree("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_NE(version.text.find("sdf kernels"), std::string::npos);
}

TEST_F(Program, MissingCaseFile) {
  Outcome const outcome = scree("run absent.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.text.find("absent.toml: no such case file"), std::string::npos) << outcome.text;
}

TEST_F(Program, MalformedToml) { expect_refused("[case\nname = 1\n", 2, {"bad.toml:1:", "TOML syntax"}); }

TEST_F(Program, UnknownKeyAndNegativeDensityTogether) {
  std::string const text =
      with(with(small_case, "density = 2650", "density = -2650"), "stiffness = 2e6", "stifness = 2e6");
  expect_refused(text, 2,
                 {"bad.toml:10: material.rock.density: -2650", "must be > 0",
                  "bad.toml:13:", "stifness: is an unknown key", "did you mean 'stiffness'?"});
}

TEST_F(Program, MissingLibraryFile) {
  expect_refused(case_with_library("grains:ballast/*"), 2, {"library.grains.file", "'model.h5' was not found"});
}

TEST_F(Program, UnknownShape) {
  write_small_model("model.h5");
  expect_refused(case_with_library("grains:balast/0"), 2, {"balast/0"});
}

TEST_F(Program, TruncatedModel) {
  fs::path const model = write_small_model("model.h5");
  fs::resize_file(model, fs::file_size(model) * 2 / 3);
  expect_refused(case_with_library("grains:ballast/0"), 2, {"model.h5", "cut short"});
}

TEST_F(Program, NanWeight) {
  fs::path const model = write_small_model("model.h5"), damaged = folder_ / "damaged.h5";
  fs::copy_file(model, damaged);
  hid_t const file = H5Fopen(damaged.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  hid_t const weights = H5Dopen2(file, "/net/0/w0", H5P_DEFAULT);
  ASSERT_GE(weights, 0);
  std::vector<float> const values(24, std::nanf(""));
  ASSERT_GE(H5Dwrite(weights, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Dclose(weights);
  H5Fclose(file);
  seal_container(damaged, model, "scree.model", 1);  // a sound file with a rotten weight
  expect_refused(case_with_library("grains:ballast/0"), 2, {"model.h5", "NaN"});
}

TEST_F(Program, DeviceThatIsNotThere) {
  try {
    GTEST_SKIP() << "there is one: " << cuda_device().name;
  } catch (DeviceError const&) {
  }
  write("small.toml", small_case);
  Outcome const cuda = scree("run small.toml --device cuda");
  EXPECT_EQ(cuda.code, 3);
  EXPECT_NE(cuda.text.find("--device cuda"), std::string::npos) << cuda.text;
  EXPECT_FALSE(fs::exists(folder_ / "small.out"));
  Outcome const automatic = scree("run small.toml --device auto");
  EXPECT_EQ(automatic.code, 0);
  EXPECT_NE(automatic.text.find("(auto: "), std::string::npos) << automatic.text;

  std::string const render = "render small.out/results.h5 -o picture.png --size 64x48 --device ";
  Outcome const cuda_picture = scree(render + "cuda");
  EXPECT_EQ(cuda_picture.code, 3);
  EXPECT_NE(cuda_picture.text.find("--device cuda: "), std::string::npos) << cuda_picture.text;
  EXPECT_FALSE(fs::exists(folder_ / "picture.png"));
  Outcome const automatic_picture = scree(render + "auto");
  EXPECT_EQ(automatic_picture.code, 0);
  EXPECT_NE(automatic_picture.text.find("(auto: "), std::string::npos) << automatic_picture.text;
  EXPECT_TRUE(fs::exists(folder_ / "picture.png"));
  EXPECT_EQ(scree(render + "gpu").code, 2);
}

TEST_F(Program, OutputFolderWithContentNeedsForce) {
  write("small.toml", small_case);
  fs::create_directories(folder_ / "small.out");
  write("small.out/results.h5", "old");
  write("small.out/notes.txt", "mine");
  Outcome const refused = scree("run small.toml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.text.find("--force"), std::string::npos) << refused.text;
  EXPECT_EQ(read_file(folder_ / "small.out/results.h5"), "old");
  EXPECT_EQ(scree("run small.toml --force").code, 0);
  EXPECT_EQ(ResultsReader(folder_ / "small.out/results.h5").frames(), 3);
  EXPECT_EQ(read_file(folder_ / "small.out/notes.txt"), "mine");
}

TEST_F(Program, OutputFolderInUse) {
  write("small.toml", small_case);
  fs::create_directories(folder_ / "small.out");
  int const lock = ::open((folder_ / "small.out/.lock").c_str(), O_RDWR | O_CREAT, 0644);
  ASSERT_EQ(::flock(lock, LOCK_EX), 0);
  Outcome const outcome = scree("run small.toml --force");
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.text.find("another run is writing"), std::string::npos) << outcome.text;
  ::close(lock);
  EXPECT_EQ(scree("run small.toml --force").code, 0);
}

TEST_F(Program, UnwritableOutput) {
  write("small.toml", small_case);
  write("in_the_way", "a file");
  Outcome const file = scree("run small.toml --output in_the_way");
  EXPECT_EQ(file.code, 4);
  EXPECT_NE(file.text.find("in_the_way: is not a folder"), std::string::npos) << file.text;
  EXPECT_EQ(read_file(folder_ / "in_the_way"), "a file");
  Outcome const below = scree("run small.toml --output in_the_way/out");
  EXPECT_EQ(below.code, 4);
  EXPECT_NE(below.text.find("in_the_way/out"), std::string::npos) << below.text;
  // Not even root makes folders there.
  Outcome const proc = scree("run small.toml --output /proc/scree_test");
  EXPECT_EQ(proc.code, 4);
  EXPECT_NE(proc.text.find("/proc/scree_test"), std::string::npos) << proc.text;
}

TEST_F(Program, WatchStopsWithTheStateWritten) {
  // 1 m/s into the floor overlaps by far more than 1e-5 d.
  write("small.toml", std::string(small_case) + "[limits]\noverlap = 1e-5\n");
  Outcome const outcome = scree("run small.toml");
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("overlap"), std::string::npos);
  EXPECT_NE(outcome.text.find("floor"), std::string::npos);
  ResultsReader const results(folder_ / "small.out/results.h5");
  double const stopped = results.frame(-1).time;
  EXPECT_GT(stopped, 0.0009);  // the floor is 1 mm away at 1 m/s
  EXPECT_LT(stopped, 0.0011);
}

TEST_F(Program, InterruptLeavesCompleteFiles) {
  write("long.toml",
        with(with(small_case, "end = 0.002", "end = 1000"), "[gravity]\nacceleration = [0, 0, -9.81]\n", ""));
  pid_t const child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    int const null = ::open("/dev/null", O_WRONLY);
    ::dup2(null, 1);
    ::dup2(null, 2);
    std::string const file = (folder_ / "long.toml").string(), out = (folder_ / "long.out").string();
    ::execl(SCREE_PROGRAM, "scree", "run", file.c_str(), "--output", out.c_str(), nullptr);
    ::_exit(127);
  }
  fs::path const ledger = folder_ / "long.out/ledger.csv";
  std::error_code error;
  for (int i = 0; i < 2000 && !(fs::exists(ledger) && fs::file_size(ledger, error) > 1000); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_GT(ResultsReader(folder_ / "long.out/results.h5").frames(), 3);
  EXPECT_TRUE(fs::exists(folder_ / "long.out/stages.json"));
}

}  // namespace
}  // namespace scree
