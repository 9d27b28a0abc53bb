// cli_test.cpp: the scree program as its users meet it: exit codes, messages, and nothing overwritten on bad input.
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include "core/case.h"
#include "core/expected_figures.h"
#include "core/results.h"
#include "kernels/base/device.h"
#include "shapes/analytic_shapes.h"
#include "shapes/file_container.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "tests/support/pebble_decoder.h"
#include "tests/support/shell.h"

namespace {

using namespace scree;
using scree::testing::Outcome;
using scree::testing::shell;
namespace fs = std::filesystem;

// One sphere 1 mm above a floor, 2 ms: a run of a fraction of a second.
char const* const small_case = R"([case]
name = "small"
[time]
end = 0.002
step = 1e-5
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e6 }
[[grains]]
name = "one"
material = "rock"
shapes = ["sphere"]
evaluator = "analytic"
diameter = 0.1
insert = { kind = "list", position = [[0, 0, 0.051]], velocity = [0, 0, -1] }
[[wall]]
name = "floor"
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "rock"
[output]
every = 0.001
)";

std::string with(std::string text, std::string const& from, std::string const& to) {
  std::size_t const at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("test text lacks: " + from);
  return text.replace(at, from.size(), to);
}

std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class Program : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_cli_test_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome scree(std::string const& arguments) const { return shell(folder_, SCREE_PROGRAM " " + arguments); }

  fs::path write(std::string const& name, std::string const& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  // `scree run` of this text must fail with exactly this code, say all of `parts`, and leave no trace, also not in
  // the output folder of an earlier run that --force would replace.
  void expect_refused(std::string const& text, int code, std::vector<std::string> const& parts) const {
    write("bad.toml", text);
    fs::create_directories(folder_ / "old");
    write("old/results.h5", "results of an earlier run");
    Outcome const outcome = scree("run bad.toml --force --output old");
    EXPECT_EQ(outcome.code, code) << outcome.text;
    for (std::string const& part : parts)
      EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text << "lacks: " << part;
    EXPECT_EQ(read_file(folder_ / "old/results.h5"), "results of an earlier run");
    EXPECT_EQ(scree("run bad.toml --output new").code, code);
    EXPECT_FALSE(fs::exists(folder_ / "new"));
  }

  // A model file with one small network, "ballast/0": phi = 0.5 - |x|_1-like, enough to be read.
  fs::path write_small_model(char const* name) const {
    Library library;
    Mlp net;
    net.width = {3, 8, 1};
    net.weight = {std::vector<float>(24, 0.1f), std::vector<float>(8, -0.1f)};
    net.bias = {std::vector<float>(8, 0.0f), {0.3f}};
    library.net.push_back(net);
    Shape shape = make_sphere();
    shape.name = "ballast/0";
    shape.kind = ShapeKind::net;
    shape.net = 0;
    library.shape.push_back(shape);
    write_model(folder_ / name, library);
    return folder_ / name;
  }

  std::string case_with_library(std::string const& shape) const {
    return with(with(small_case, "[\"sphere\"]\nevaluator = \"analytic\"", "[\"" + shape + "\"]"), "[[material]]",
                "[[library]]\nname = \"grains\"\nfile = \"model.h5\"\n[[material]]");
  }

  fs::path folder_;
};

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
  EXPECT_EQ(scree("info small.out/results.h5").code, 0);
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

TEST_F(Program, RenderDrawsAFrameAndRefusesNonsense) {
  write("small.toml", small_case);
  ASSERT_EQ(scree("run small.toml").code, 0);
  Outcome const drawn = scree("render small.out/results.h5 -o picture.png --ids ids.png --frame 0 --size 64x48");
  EXPECT_EQ(drawn.code, 0) << drawn.text;
  EXPECT_NE(drawn.text.find("100 % of 1 grains visible"), std::string::npos) << drawn.text;
  for (char const* name : {"picture.png", "ids.png"}) EXPECT_EQ(read_file(folder_ / name).substr(1, 3), "PNG") << name;
  EXPECT_EQ(scree("render small.out/results.h5 -o x.png --frame 99").code, 2);
  EXPECT_EQ(scree("render small.out/results.h5 -o x.png --size 64").code, 2);
  EXPECT_EQ(scree("render absent.h5 -o x.png").code, 2);
  EXPECT_EQ(scree("render small.out/results.h5 -o /proc/x.png --size 64x48").code, 4);
  EXPECT_FALSE(fs::exists(folder_ / "x.png"));
}

TEST_F(Program, EnvelopesWriteTablesAndPictures) {
  write("small.toml", small_case);
  ASSERT_EQ(scree("run small.toml --threads 1").code, 0);
  auto const expect_refused = [&](std::string const& arguments, std::string const& part) {
    Outcome const outcome = scree("envelopes " + arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.text;
    EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text;
    EXPECT_FALSE(fs::exists(folder_ / "env"));
  };
  expect_refused("small.out/results.h5 -o env", "no run_out measurement; name it with --direction");
  expect_refused("small.out/results.h5 -o env --direction 0,0,1", "no horizontal part");
  expect_refused("small.out/results.h5 -o env --direction 1,0", "--direction");
  expect_refused("small.out/results.h5 -o env --direction 1,0,0 --bin 0", "--bin");
  expect_refused("small.out/results.h5 small.out/results.h5 -o env --direction 1,0,0", "named twice");
  expect_refused("absent.h5 -o env --direction 1,0,0", "absent.h5");
  expect_refused("small.out/results.h5 -o small.toml --direction 1,0,0", "small.toml is a file");

  // A Matplotlib that cannot be imported stands before the real one: tables all the same.
  fs::create_directories(folder_ / "broken");
  write("broken/matplotlib.py", "raise ImportError\n");
  std::string const command = "envelopes small.out/results.h5 -o env --direction 1,0,0";
  ::setenv("PYTHONPATH", (folder_ / "broken").c_str(), 1);
  Outcome const bare = scree(command);
  ::unsetenv("PYTHONPATH");
  EXPECT_EQ(bare.code, 0) << bare.text;
  EXPECT_NE(bare.text.find("Matplotlib was not found"), std::string::npos) << bare.text;
  EXPECT_FALSE(fs::exists(folder_ / "env/envelopes.png"));
  for (char const* const table : {"groups", "grains", "run_out", "plan", "screens", "velocity"})
    EXPECT_TRUE(fs::exists(folder_ / "env" / (std::string(table) + ".csv"))) << table;
  EXPECT_EQ(read_file(folder_ / "env/groups.csv").rfind("group,replicas,grains,", 0), 0u);

  Outcome const again = scree(command);
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.text.find("--force"), std::string::npos) << again.text;
  Outcome const drawn = scree(command + " --force");
  EXPECT_EQ(drawn.code, 0) << drawn.text;
  bool const pictures = drawn.text.find("envelopes.png, plan.png") != std::string::npos;  // where Matplotlib is
  EXPECT_NE(pictures, drawn.text.find("no pictures: Matplotlib was not found") != std::string::npos) << drawn.text;
  for (char const* const picture : {"env/envelopes.png", "env/plan.png"})
    EXPECT_EQ(fs::exists(folder_ / picture), pictures) << picture;
}

TEST_F(Program, EnergyDrawsTheLedgerWithEveryNameInIt) {
  // An applied force and drag, so that the ledger has columns that not every run has.
  write("small.toml", with(small_case, "[output]\nevery = 0.001",
                           "[drag]\ndensity = 1.2\ncoefficient = 0.5\n[[force]]\nname = \"push\"\ngrains = "
                           "\"one\"\nforce = [1, 0, 0]\n[output]\nevery = 0.0005"));
  ASSERT_EQ(scree("run small.toml --output out").code, 0);
  Outcome const drawn = scree("energy out/results.h5 -o ledger.svg");
  if (drawn.text.find("Matplotlib was not found") != std::string::npos) {
    EXPECT_EQ(drawn.code, 4) << drawn.text;
    GTEST_SKIP() << drawn.text;
  }
  ASSERT_EQ(drawn.code, 0) << drawn.text;
  EXPECT_NE(drawn.text.find("ledger.svg: 5 rows to t = 0.002 s, residual"), std::string::npos) << drawn.text;
  // Matplotlib writes each text of an SVG into a comment beside its outline.
  std::string const picture = read_file(folder_ / "ledger.svg");
  for (char const* name : {"kinetic", "potential, less its start", "elastic, normal", "elastic, tangential",
                           "in: work of moving walls", "in: applied forces", "out: contact damping", "out: friction",
                           "out: drag", "out: numerical removals", "residual [J]", "of the energy moved so far"})
    EXPECT_NE(picture.find(name), std::string::npos) << name;
  for (char const* name : {"rolling resistance", "deleted", "inserted", "global damping"})
    EXPECT_EQ(picture.find(name), std::string::npos) << name << ": the case lacks the effect";
  EXPECT_EQ(scree("energy out/results.h5 -o ledger.pdf").code, 2);
  EXPECT_EQ(scree("energy small.toml -o ledger.png").code, 2);
}

TEST_F(Program, ExportsTheGrainsOfAFrameAsMeshes) {
  write("small.toml", small_case);
  ASSERT_EQ(scree("run small.toml").code, 0);
  Outcome const whole = scree("export small.out/results.h5 --stl --frame 0");
  ASSERT_EQ(whole.code, 0) << whole.text;
  MeshMass const mass = mesh_mass(read_mesh(folder_ / "small.out/grains.stl"));
  EXPECT_NEAR(mass.volume, M_PI / 6 * 1e-3, 0.02 * M_PI / 6 * 1e-3);  // 1,280 chords of a sphere
  EXPECT_NEAR(norm(mass.centroid - Vec3{0, 0, 0.051}), 0, 1e-7);      // float coordinates
  Outcome const each = scree("export small.out/results.h5 --stl --per-grain --format ply -o each");
  ASSERT_EQ(each.code, 0) << each.text;
  EXPECT_EQ(read_mesh(folder_ / "each/grain_000000.ply").triangle.size(), 1280u);
  std::string const before = read_file(folder_ / "small.out/grains.stl");
  Outcome const again = scree("export small.out/results.h5 --stl");
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.text.find("--force"), std::string::npos) << again.text;
  EXPECT_EQ(read_file(folder_ / "small.out/grains.stl"), before);
  EXPECT_EQ(scree("export small.out/results.h5 --stl --force").code, 0);
  EXPECT_EQ(scree("export small.out/results.h5 --stl --frame 99 -o x.stl").code, 2);
  EXPECT_EQ(scree("export small.out/results.h5 --stl --format step -o x.stl").code, 2);
  EXPECT_EQ(scree("export small.out/results.h5 --stl -o x.ply").code, 2);
  EXPECT_EQ(scree("export small.out/results.h5 --per-grain").code, 2);
  EXPECT_EQ(scree("export absent.h5 --stl").code, 2);
  EXPECT_EQ(scree("export small.out/results.h5 --stl -o nowhere/x.stl").code, 4);
  EXPECT_FALSE(fs::exists(folder_ / "x.stl"));
}

TEST_F(Program, SampledGrainsRunAndTheirResultsStandAlone) {
  write_model(folder_ / "model.h5", test::pebble_library());
  std::string const sample = "sample = { library = \"grains\", category = \"flat\" }\nnodes = 250";
  std::string text = with(case_with_library("x"), "shapes = [\"x\"]", sample);
  text = with(text, "position = [[0, 0, 0.051]]", "position = [[0, 0, 0.09], [0.3, 0, 0.09]]");
  write("made.toml", text);
  Outcome const checked = scree("check made.toml");
  EXPECT_EQ(checked.code, 0) << checked.text;
  EXPECT_NE(checked.text.find("2 bodies of 2 shapes"), std::string::npos) << checked.text;
  EXPECT_NE(checked.text.find("grains 'one': 2 tries of flat: 2 accepted"), std::string::npos) << checked.text;
  EXPECT_EQ(scree("plan made.toml").code, 0);
  std::vector<std::vector<float>> first;
  for (std::string const storage : {"explicit", "compact"}) {
    Outcome const run = scree("run made.toml --output " + storage + " --set 'grains.one.storage=\"" + storage + "\"'");
    ASSERT_EQ(run.code, 0) << run.text;
    EXPECT_NE(run.text.find("2 tries of flat"), std::string::npos) << run.text;
    fs::remove(folder_ / "model.h5.away");
    fs::rename(folder_ / "model.h5", folder_ / "model.h5.away");  // results need no library
    ResultsReader const results(folder_ / storage / "results.h5");
    std::vector<std::vector<float>> codes;
    for (int shape : results.header().shape) codes.push_back(results.header().library.shape[shape].code);
    ASSERT_EQ(codes.size(), 2u);
    EXPECT_NE(codes[0], codes[1]);
    if (first.empty()) first = codes;
    EXPECT_EQ(codes, first) << "the storage changed the grains";
    EXPECT_EQ(scree("info " + storage + "/results.h5").code, 0);
    EXPECT_EQ(scree("export " + storage + "/results.h5").code, 0);
    EXPECT_TRUE(fs::exists(folder_ / storage / "paraview/scene.pvd"));
    Outcome const meshes = scree("export " + storage + "/results.h5 --stl");
    EXPECT_EQ(meshes.code, 0) << meshes.text;
    TriangleMesh const grains = read_mesh(folder_ / storage / "grains.stl");
    double const volume = mesh_mass(grains).volume, d3 = 1e-3;
    EXPECT_NEAR(volume, 2 * M_PI / 6 * d3, 0.02 * d3);  // of a coarse mesh: chords lie inside
    fs::rename(folder_ / "model.h5.away", folder_ / "model.h5");
  }
  // What was written as the effective case makes the same grains again.
  Outcome const again = scree("run compact/case.effective.toml --output again");
  ASSERT_EQ(again.code, 0) << again.text;
  ResultsReader const a(folder_ / "compact/results.h5"), b(folder_ / "again/results.h5");
  EXPECT_EQ(a.frame(-1).position, b.frame(-1).position);
}

TEST_F(Program, InfoReadsModelsAndRefusesOtherFiles) {
  write_small_model("model.h5");
  Outcome const model = scree("info model.h5");
  EXPECT_EQ(model.code, 0) << model.text;
  EXPECT_NE(model.text.find("ballast/0"), std::string::npos);
  write("text.h5", "no HDF5 at all");
  Outcome const text = scree("info text.h5");
  EXPECT_EQ(text.code, 2);
  EXPECT_NE(text.text.find("text.h5"), std::string::npos) << text.text;
}

// Spheres at random places, their share of half the box: another one for every seed.
std::string scattered() {
  std::string text = with(small_case, "insert = { kind = \"list\", position = [[0, 0, 0.051]], velocity = [0, 0, -1] }",
                          "count = 6\ninsert = { kind = \"random\", box = [[0, 0, 0.1], [1, 1, 1.1]] }");
  return with(text, "[output]",
              "[[measure]]\nname = \"half\"\nkind = \"packing_fraction\"\nbox = [[0, 0, 0], [0.5, 1, 1.2]]\n[output]");
}

TEST_F(Program, ExpectedFiguresComeFromSeedsAndJudgeARun) {
  write("spheres.toml", scattered());
  std::string const script =
      "SCREE=" SCREE_PROGRAM " " SCREE_SOURCE_DIR "/tools/expected.sh spheres.toml 3 --keep runs";
  ASSERT_EQ(std::system(("cd " + folder_.string() + " && " + script + " >log 2>&1").c_str()), 0)
      << read_file(folder_ / "log");
  double value[3], mean = 0, square = 0;
  for (int k = 0; k < 3; ++k) {
    ResultsReader const run(folder_ / ("runs/" + std::to_string(k + 1) + "/results.h5"));
    ASSERT_EQ(run.measures().at(0).name, "half.fraction");
    mean += (value[k] = run.measures()[0].last) / 3;
  }
  for (double const v : value) square += (v - mean) * (v - mean);
  std::string const text = read_file(folder_ / "expected.toml");
  std::vector<ExpectedFigure> const expected = read_expected(folder_ / "expected.toml");
  ASSERT_EQ(expected.at(0).name, "half.fraction");
  double const spread = std::sqrt(square / 2);
  EXPECT_GT(spread, 0.1 * mean);
  EXPECT_NEAR(expected[0].value, mean, 1e-5 * mean);  // six digits are written
  EXPECT_NEAR(expected[0].spread, spread, 1e-2 * spread);
  EXPECT_NEAR(expected[0].tolerance, 4.303 * std::sqrt(4 / 3.0) * spread, 1e-2 * spread * 5);
  Outcome const good = scree("info runs/2/results.h5 --expected expected.toml");
  EXPECT_EQ(good.code, 0) << good.text;
  EXPECT_NE(good.text.find("ok"), std::string::npos);
  write("other.toml", "[[expected]]\nname = \"half.fraction\"\nvalue = 0.9\ntolerance = 0.01\n");
  Outcome const bad = scree("info runs/2/results.h5 --expected other.toml");
  EXPECT_EQ(bad.code, 1) << bad.text;
  EXPECT_NE(bad.text.find("OUTSIDE"), std::string::npos);
  write("unknown.toml", "[[expected]]\nname = \"no.such\"\nvalue = 0\ntolerance = 1e9\n");
  EXPECT_EQ(scree("info runs/2/results.h5 --expected unknown.toml").code, 1);  // what is not measured is not good
  write("wrong.toml", "[[expected]]\nname = \"half.fraction\"\nvalue = 0\ntolerence = 1\n");
  Outcome const wrong = scree("info runs/2/results.h5 --expected wrong.toml");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_NE(wrong.text.find("did you mean 'tolerance'"), std::string::npos) << wrong.text;
  std::string const csv = read_file(folder_ / "runs/1/measures.csv");
  EXPECT_TRUE(csv.starts_with("time,name,quantity,value\n0.001,half,fraction,")) << csv;
  write("small.toml", small_case);
  ASSERT_EQ(scree("run small.toml").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "small.out/measures.csv"));
  EXPECT_EQ(scree("info small.out/results.h5 --expected expected.toml").code, 2);
}

}  // namespace
