// cli_output_test.cpp: what the scree program makes of results: pictures, tables, meshes, judgements.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/expected_figures.h"
#include "core/results.h"
#include "core/results_hdf5.h"
#include "shapes/mesh_files.h"
#include "tests/core/program_fixture.h"
#include "tests/support/pebble_decoder.h"

namespace scree {
namespace {

using namespace testing;

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

TEST_F(Program, ExportsTheGrainsOfARunAsOneTimeSeries) {
  write("small.toml", small_case);
  ASSERT_EQ(scree("run small.toml").code, 0);
  Outcome const outcome = scree("export small.out/results.h5 --vtkhdf");
  ASSERT_EQ(outcome.code, 0) << outcome.text;
  ResultsReader const results(folder_ / "small.out/results.h5");
  hdf5::Handle const file = hdf5::open_file((folder_ / "small.out/paraview/grains.vtkhdf").string());
  auto const time = results_hdf5::read_array<double>(file, "VTKHDF/Steps/Values");
  auto const point = results_hdf5::read_array<double>(file, "VTKHDF/Points", {3});
  ASSERT_EQ(static_cast<int>(time.size()), results.frames());
  ASSERT_EQ(point.size(), 3 * time.size());  // one grain
  for (std::size_t k = 0; k < time.size(); ++k) {
    EXPECT_EQ(time[k], results.frame(static_cast<int>(k)).time);
    EXPECT_EQ(point[3 * k + 2], results.frame(static_cast<int>(k)).position.at(0).z);
  }
  EXPECT_FALSE(fs::exists(folder_ / "small.out/paraview/scene.pvd"));
  EXPECT_EQ(scree("export small.out/results.h5 --vtkhdf -o x.vtkhdf").code, 0);
  EXPECT_EQ(scree("export small.out/results.h5 --vtkhdf -o x.vtkhdf").code, 0);  // replaced, as the folder's files are
  EXPECT_EQ(scree("export small.out/results.h5 --vtkhdf -o small.out/results.h5").code, 2);
  EXPECT_EQ(scree("info small.out/results.h5").code, 0);
  EXPECT_EQ(scree("export small.out/results.h5 --vtkhdf --stl").code, 2);
  EXPECT_EQ(scree("export small.out/results.h5 --vtkhdf -o nowhere/x.vtkhdf").code, 4);
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

// A ball has no nodes to pick, only the step. What was picked, written out, repeats the run bit by bit.
TEST_F(Program, AccuracyPicksAndTheEffectiveCaseRepeatsTheRun) {
  write("small.toml", with(with(small_case, "step = 1e-5\n", ""), "[[material]]",
                           "[accuracy]\npreset = \"fast\"\n[checkpoint]\n[[material]]"));
  std::string const cache = "env SCREE_CACHE=" + (folder_ / "cache").string() + " ";
  auto const scree = [&](std::string const& arguments) {
    return shell(folder_, cache + SCREE_PROGRAM " " + arguments);
  };
  Outcome const check = scree("check small.toml");
  EXPECT_EQ(check.code, 0) << check.text;
  EXPECT_NE(check.text.find("accuracy: asked for 15 %"), std::string::npos) << check.text;
  EXPECT_NE(check.text.find("accuracy: time.safety = 0.5,"), std::string::npos) << check.text;
  EXPECT_NE(scree("plan small.toml").text.find("accuracy: predicted"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "cache"), fs::directory_iterator()), 1);  // measured once
  Outcome const run = scree("run small.toml -o first");
  ASSERT_EQ(run.code, 0) << run.text;
  EXPECT_NE(run.text.find("us of processor time a particle-step, predicted"), std::string::npos) << run.text;
  std::string const effective = read_file(folder_ / "first/case.effective.toml");
  EXPECT_EQ(effective.find("[accuracy]"), std::string::npos);
  EXPECT_TRUE(effective.starts_with("# accuracy: asked for 15 %"));
  EXPECT_NE(effective.find("\nsafety = 0.5\n"), std::string::npos);
  ASSERT_EQ(scree("run first/case.effective.toml -o second").code, 0);
  EXPECT_EQ(read_file(folder_ / "second/ledger.csv"), read_file(folder_ / "first/ledger.csv"));
  EXPECT_EQ(read_file(folder_ / "second/case.effective.toml"), effective.substr(effective.find("[case]")));
  // A run that goes on keeps what it began with, whatever would be picked now: another safety there is another case.
  Outcome const longer = scree("run small.toml -o first --resume --set time.end=0.003");
  EXPECT_EQ(longer.code, 0) << longer.text;
  EXPECT_NE(longer.text.find("as picked when the run began"), std::string::npos) << longer.text;
  write("first/case.effective.toml", with(effective, "\nsafety = 0.5", "\nsafety = 0.4"));
  Outcome const other = scree("run small.toml -o first --resume --set time.end=0.004");
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.text.find("safety = 0.4"), std::string::npos) << other.text;
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
}  // namespace scree
