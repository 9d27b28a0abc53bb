// case_test.cpp: the case file: what its keys and overrides mean, and where its files are looked for.
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/case.h"
#include "tests/core/case_file_fixture.h"

namespace scree {
namespace {

using namespace testing;

TEST_F(CaseFile, MinimalCaseMeansWhatItSays) {
  Case const c = load(minimal);
  EXPECT_EQ(c.name, "drop");
  EXPECT_EQ(c.time.end, 1.5);
  EXPECT_FALSE(c.time.step.has_value());
  EXPECT_FALSE(c.time.settle.has_value());
  EXPECT_EQ(*c.gravity, (Vec3{0, 0, -9.81}));
  EXPECT_EQ(c.contact.at(0).stiffness, 2e6);
  EXPECT_FALSE(c.contact[0].kappa.has_value());
  EXPECT_EQ(*c.contact[0].friction, 0.5);
  EXPECT_EQ(*c.contact[0].damping_ratio, 0.7);
  EXPECT_EQ(c.grains.at(0).count, 5);
  EXPECT_EQ(c.grains[0].nodes, 4000);
  EXPECT_EQ(c.grains[0].insert.box.max, (Vec3{1, 1, 4}));
  EXPECT_EQ(c.wall.at(0).kind, WallKind::plane);
  EXPECT_FALSE(c.checkpoint.has_value());
}

TEST_F(CaseFile, AbsentKeysAreAbsentEffects) {
  std::string text = with(minimal, "[gravity]\nacceleration = [0, 0, -9.81]\n", "");
  text = with(text, "friction = 0.5\ndamping = { ratio = 0.7 }\n", "");
  Case const c = load(text);
  EXPECT_FALSE(c.gravity.has_value());
  EXPECT_FALSE(c.contact.at(0).friction.has_value());
  EXPECT_FALSE(c.contact[0].damping_ratio.has_value());
  EXPECT_FALSE(c.contact[0].restitution.has_value());
}

TEST_F(CaseFile, EvaluatorsAndTheirCells) {
  Case const grid = load(with(minimal, "count = 5", "count = 5\nevaluator = \"grid\"\ngrid_cells = 60"));
  EXPECT_EQ(grid.grains.at(0).evaluator, Evaluator::grid);
  EXPECT_EQ(grid.grains[0].grid_cells, 60);
  Case const again = load(to_toml(grid));
  EXPECT_EQ(again.grains.at(0).evaluator, Evaluator::grid);
  EXPECT_EQ(again.grains[0].grid_cells, 60);
  EXPECT_EQ(load(with(minimal, "count = 5", "count = 5\nevaluator = \"mesh\"")).grains.at(0).mesh_cells, 16);
  expect_one(refused(with(minimal, "count = 5", "count = 5\ngrid_cells = 60")),
             {"grains.mix.grid_cells", "evaluator = \"grid\" only"});
  expect_one(refused(with(minimal, "count = 5", "count = 5\nevaluator = \"mesh\"\nmesh_cells = 2")),
             {"grains.mix.mesh_cells", "2 is out of range"});
}

TEST_F(CaseFile, MeshFilesAreLookedForBesideTheCase) {
  write("solid\nendsolid\n", "rock.stl");
  std::string const text = with(minimal, "\"sphere\"", "\"mesh:rock.stl\"");
  Case const c = load(text);
  EXPECT_EQ(c.grains.at(0).shapes.at(0), "mesh:" + fs::weakly_canonical(folder_ / "rock.stl").string());
  EXPECT_EQ(mesh_file_of(c.grains[0].shapes[0]).filename(), "rock.stl");
  EXPECT_EQ(mesh_file_of("sphere"), "");
  expect_one(refused(with(text, "rock.stl", "stone.stl")), {"grains.mix.shapes", "'stone.stl' was not found; tried"});
  write("", "grains.h5");
  expect_one(refused(std::string(minimal) + "[[library]]\nname = \"mesh\"\nfile = \"grains.h5\"\n"),
             {"library.mesh.name", "choose another name"});
}

TEST_F(CaseFile, ShapesMadeForTheCase) {
  write("", "grains.h5");
  std::string const text = std::string(minimal) + "[[library]]\nname = \"grains\"\nfile = \"grains.h5\"\n";
  auto const instead = [&](std::string const& keys) { return with(text, "shapes = [\"sphere\"]", keys); };
  std::string const sample = "sample = { library = \"grains\", category = \"ballast\" }";
  std::string const line = "interpolate = { library = \"grains\", from = \"a/0\", to = \"b/1\", t = 0.25 }";
  Case const c = load(instead(with(sample, " }", ", truncate = 1.5, flatness = [0.25, 1.0] }")));
  SampleCase expected{"grains", "ballast", 1.5, {}, {}, {}, {0.25, 1}, {}};
  EXPECT_EQ(c.grains.at(0).sample, expected);
  EXPECT_FALSE(c.grains[0].interpolate.has_value());
  EXPECT_TRUE(c.grains[0].shapes.empty());
  InterpolateCase between{"grains", "a/0", "b/1", 0.25, 0.25};
  EXPECT_EQ(load(instead(line)).grains.at(0).interpolate, between);
  between = {"grains", "a/0", "b/1", 0.25, 0.5};
  EXPECT_EQ(load(instead(with(line, "0.25", "[0.25, 0.5]"))).grains.at(0).interpolate, between);
  between = {"grains", "a/0", "b/1", 0, 1, true};
  Case const random = load(instead(with(line, "0.25", "\"random\"")));
  EXPECT_EQ(random.grains.at(0).interpolate, between);
  EXPECT_EQ(load(to_toml(random)).grains.at(0).interpolate, between);

  expect_one(refused(instead("")), {"grains.mix.shapes: must name at least one shape", "give sample or interpolate"});
  expect_one(refused(instead("shapes = [\"sphere\"]\n" + sample)),
             {"case.toml:19: grains.mix.sample: has no meaning beside shapes", "exactly one of"});
  expect_one(refused(instead(sample + "\n" + line)), {"grains.mix.sample: has no meaning beside interpolate"});
  expect_one(refused(instead(with(sample, "grains", "grians"))), {"unknown library 'grians'", "'grains'"});
  expect_one(refused(instead(with(sample, " }", ", truncate = 0 }"))), {"grains.mix.sample.truncate: 0 is out"});
  expect_one(refused(instead(with(sample, " }", ", flatness = [0.5, 0.25] }"))),
             {"grains.mix.sample.flatness: [0.5, 0.25] is empty"});
  expect_one(refused(instead(with(sample, " }", ", flatness = [1.5, 2] }"))), {"holds no grain", "between 0 and 1"});
  expect_one(refused(instead(with(sample, " }", ", flatnes = [0, 1] }"))), {"did you mean 'flatness'?"});
  expect_one(refused(instead(with(sample, " }", ", flatness = 0.5 }"))), {"must be two numbers [low, high]"});
  expect_one(refused(instead(sample + "\nevaluator = \"analytic\"")), {"grains.mix.evaluator", "needs formulas"});
  expect_one(refused(instead(sample + "\nevaluator = \"grid\"\nstorage = \"compact\"")),
             {"grains.mix.storage", "run as networks"});
  expect_one(refused(instead(with(line, "t = 0.25", "t = \"some\""))), {"'some' is unknown; write a number"});
  expect_one(refused(instead(with(line, "0.25", "[0.5, 1.5]"))), {"grains.mix.interpolate.t: 1.5 is out of range"});
  expect_one(refused(instead(with(line, "0.25", "[0.5, 0.25]"))), {"[0.5, 0.25] is empty"});
  expect_one(refused(instead(with(line, ", t = 0.25", ""))), {"grains.mix.interpolate.t: is missing"});
}

TEST_F(CaseFile, FastNodesAndExplicitStep) {
  Case const c =
      load(with(with(minimal, "count = 5", "count = 5\nnodes = \"fast\""), "end = 1.5", "end = 1.5\nstep = 1e-5"));
  EXPECT_EQ(c.grains.at(0).nodes, 1000);
  EXPECT_EQ(*c.time.step, 1e-5);
}

TEST_F(CaseFile, ListInsertionCountsItself) {
  Case const c = load(with(with(minimal, "kind = \"lattice\", box = [[0, 0, 0], [1, 1, 4]]",
                                "kind = \"list\", position = [[0, 0, 1], [0, 0, 2.5]], quaternion = [[1, 0, 0, 0], [0, "
                                "1, 0, 0]], spin = [0, 0, 3]"),
                           "count = 5\n", ""));
  EXPECT_EQ(c.grains.at(0).count, 2);
  EXPECT_EQ(c.grains[0].insert.position.at(1), (Vec3{0, 0, 2.5}));
  EXPECT_EQ(c.grains[0].insert.quaternion.at(1), (Quat{0, 1, 0, 0}));
  EXPECT_EQ(c.grains[0].insert.spin, (Vec3{0, 0, 3}));
}

TEST_F(CaseFile, ReplicasEntriesApartAndScatter) {
  std::string const text =
      with(with(minimal, "name = \"drop\"", "name = \"drop\"\nreplicas = 3"), "count = 5", "apart = true\ncount = 5");
  Case const c = load(text);
  EXPECT_EQ(c.replicas, 3);
  EXPECT_TRUE(c.grains.at(0).apart);
  Case const again = load(to_toml(c));
  EXPECT_EQ(to_toml(again), to_toml(c));
  EXPECT_TRUE(again.replicas == 3 && again.grains.at(0).apart);
  EXPECT_EQ(to_toml(load(minimal)).find("replicas"), std::string::npos);
  expect_one(refused(with(text, "replicas = 3", "replicas = 0")), {"case.replicas: 0 is out of range: must be >= 1"});
  expect_one(refused(with(minimal, "kind = \"lattice\"", "kind = \"lattice\", scatter = [0, 0, 1]")),
             {"insert.scatter: has a meaning beside kind = \"list\" and \"file\" only"});
}

TEST_F(CaseFile, Relax) {
  std::string const text = std::string(minimal) + "[relax]\noverlap = 0.002\npasses = 40\n";
  for (Case const& c : {load(text), load(to_toml(load(text)))}) {
    ASSERT_TRUE(c.relax);
    EXPECT_TRUE(c.relax->overlap == 0.002 && c.relax->travel == RelaxCase{}.travel && c.relax->passes == 40);
  }
  EXPECT_EQ(to_toml(load(minimal)).find("relax"), std::string::npos);
  expect_one(refused(with(text, "passes = 40", "passes = 0")), {"relax.passes: 0 is out of range"});
  expect_one(refused(with(text, "passes = 40", "travel = 0.5")), {"relax.travel: 0.5 is out of range"});
}

TEST_F(CaseFile, DevicePrecision) {
  for (auto [word, precision] : {std::pair("fp32", Precision::fp32), std::pair("fp16x3", Precision::fp16x3),
                                 std::pair("fast", Precision::fast)}) {
    std::string const text = std::string(minimal) + "[device]\nprecision = \"" + word + "\"\n";
    for (Case const& c : {load(text), load(to_toml(load(text)))}) {
      ASSERT_TRUE(c.device);
      EXPECT_EQ(c.device->precision, precision);
    }
  }
  EXPECT_FALSE(load(minimal).device);
  EXPECT_EQ(to_toml(load(minimal)).find("device"), std::string::npos);
  expect_one(refused(std::string(minimal) + "[device]\nprecision = \"half\"\n"),
             {"device.precision", "half", "fp16x3"});
}

TEST_F(CaseFile, EffectsOnBodies) {
  std::string const text = std::string(minimal) +
                           "[drag]\ndensity = 1.2\ncoefficient = 0.5\nfluid_velocity = [1, 0, 0]\n[damping]\nrate = "
                           "0.25\n[[force]]\nname = \"push\"\ngrains = \"mix\"\nforce = [1, 2, 3]\nstart = 0.1\nstop = "
                           "0.2\n[[force]]\nname = \"spin\"\ngrains = \"mix\"\ntorque = [0, 0, 1]\ntable = [[0, 1], "
                           "[0.5, -2]]\n";
  for (Case const& c : {load(text), load(to_toml(load(text)))}) {
    EXPECT_EQ(c.drag->density, 1.2);
    EXPECT_EQ(c.drag->coefficient, 0.5);
    EXPECT_EQ(c.drag->fluid_velocity, (Vec3{1, 0, 0}));
    EXPECT_EQ(c.damping->rate, 0.25);
    ASSERT_EQ(c.force.size(), 2u);
    EXPECT_EQ(c.force[0].force, (Vec3{1, 2, 3}));
    EXPECT_EQ(c.force[0].start, 0.1);
    EXPECT_EQ(c.force[0].stop, 0.2);
    EXPECT_TRUE(c.force[0].table.empty());
    EXPECT_EQ(c.force[1].torque, (Vec3{0, 0, 1}));
    EXPECT_EQ(c.force[1].table, (TimeTable{{0, 0.5}, {1, -2}}));
  }
  EXPECT_EQ(load(text, {"force.push.force=[9, 0, 0]"}).force[0].force, (Vec3{9, 0, 0}));
  Case const plain = load(minimal);
  EXPECT_TRUE(!plain.drag && !plain.damping && plain.force.empty());
}

TEST_F(CaseFile, Deletion) {
  std::string const text =
      std::string(minimal) +
      "[[delete]]\nname = \"below\"\nkind = \"plane\"\npoint = [0, 0, -1]\nnormal = [0, 0, 2]\n"
      "[[delete]]\nname = \"far\"\nkind = \"box\"\nmin = [-1, -2, -3]\nmax = [1, 2, 3]\n"
      "[[delete]]\nname = \"trap\"\nkind = \"box\"\nside = \"inside\"\nmin = [0, 0, 0]\nmax = [1, 2, 3]\n";
  for (Case const& c : {load(text), load(to_toml(load(text)))}) {
    ASSERT_EQ(c.deletion.size(), 3u);
    EXPECT_TRUE(c.deletion[0].plane && !c.deletion[1].plane && !c.deletion[2].plane);
    EXPECT_EQ(c.deletion[0].point, (Vec3{0, 0, -1}));
    EXPECT_EQ(c.deletion[0].normal, (Vec3{0, 0, 2}));
    EXPECT_TRUE(!c.deletion[1].inside && c.deletion[2].inside);
    EXPECT_EQ(c.deletion[1].min, (Vec3{-1, -2, -3}));
    EXPECT_EQ(c.deletion[2].max, (Vec3{1, 2, 3}));
  }
  EXPECT_TRUE(load(minimal).deletion.empty());
  expect_one(refused(text, {"delete.below.normal=[0, 0, 0]"}), {"delete.below.normal: must have a length"});
  expect_one(refused(text, {"delete.far.max=[-1, 2, 3]"}), {"delete.far.max: the box is 0 x 4 x 6 m"});
  expect_one(refused(text, {"delete.far.name=trap"}), {"'trap' is used twice"});
  expect_one(refused(text, {"delete.far.kind=ball"}), {"delete.far.kind: 'ball' is unknown", "box, plane"});
  expect_one(refused(text, {"delete.below.min=[0, 0, 0]"}), {"delete.below.min: is an unknown key"});
}

TEST_F(CaseFile, InsertionAtRandomAndByRate) {
  std::string const lattice = "kind = \"lattice\", box = [[0, 0, 0], [1, 1, 4]]";
  Case const random = load(with(minimal, "lattice", "random"));
  EXPECT_EQ(random.grains.at(0).insert.kind, InsertCase::Kind::random);
  EXPECT_EQ(to_toml(load(to_toml(random))), to_toml(random));
  std::string const text =
      with(minimal, lattice, "kind = \"rate\", box = [[0, 0, 0], [1, 1, 4]], rate = 20, start = 0.5");
  Case const rate = load(text);
  EXPECT_EQ(rate.grains.at(0).insert.kind, InsertCase::Kind::rate);
  EXPECT_EQ(rate.grains[0].insert.rate, 20);
  EXPECT_EQ(rate.grains[0].insert.start, 0.5);
  EXPECT_EQ(to_toml(load(to_toml(rate))), to_toml(rate));
  expect_one(refused(text, {"grains.mix.insert.rate=0"}), {"grains.mix.insert.rate: 0 is out of range: must be > 0"});
  expect_one(refused(text, {"grains.mix.insert.start=-1"}), {"grains.mix.insert.start: -1"});
  expect_one(refused(with(text, "rate = 20, ", "")), {"grains.mix.insert.rate: is missing"});
  expect_one(refused(with(minimal, "box = [", "rate = 3, box = [")), {"insert.rate: is an unknown key"});
  expect_one(refused(text, {"grains.mix.insert.box=[[0, 0, 0], [1, -1, 1]]"}), {"insert.box", "above the first"});
}

TEST_F(CaseFile, InsertionFromAFile) {
  std::string const text = with(with(minimal, "kind = \"lattice\", box = [[0, 0, 0], [1, 1, 4]]",
                                     "kind = \"file\", file = \"grains.csv\", velocity = [1, 0, 0]"),
                                "count = 5\n", "");
  expect_one(refused(text), {"grains.mix.insert.file: 'grains.csv' was not found; tried"});
  write("shape,x,y,z,qw,qx,qy,qz,wx,wy,wz\n1, 0.5,0,1, 1,0,0,0, 7,8,9\n0, -2,1e-1,3, 0,0,0.6,0.8, 0,0,1\r\n",
        "grains.csv");
  Case const a = load(text);
  for (Case const& c : {a, load(to_toml(a))}) {
    EXPECT_EQ(c.grains.at(0).count, 2);
    EXPECT_EQ(c.grains[0].insert.position, (std::vector<Vec3>{{0.5, 0, 1}, {-2, 0.1, 3}}));
    EXPECT_EQ(c.grains[0].insert.quaternion, (std::vector<Quat>{{1, 0, 0, 0}, {0, 0, 0.6, 0.8}}));
    EXPECT_EQ(c.grains[0].insert.spins, (std::vector<Vec3>{{7, 8, 9}, {0, 0, 1}}));
    EXPECT_EQ(c.grains[0].insert.shape, (std::vector<int>{1, 0}));
    EXPECT_TRUE(c.grains[0].insert.velocities.empty());
    EXPECT_EQ(c.grains[0].insert.velocity, (Vec3{1, 0, 0}));
  }
  expect_one(refused(text, {"grains.mix.count=3"}), {"grains.mix.count: 3 differs from the 2 positions"});
  auto const file_refused = [&](std::string const& table, std::string const& what) {
    write(table, "grains.csv");
    expect_one(refused(text), {"grains.mix.insert.file: ", "grains.csv", what});
  };
  file_refused("", "is empty");
  file_refused("x,y,z,v\n", ":1: unknown column 'v'");
  file_refused("x,y\n", "column 'z' is missing");
  file_refused("x,y,z,vy,vz\n", "column 'vx' is missing beside 'vy'");
  file_refused("x,y,z,x\n", "column 'x' is there twice");
  file_refused("x,y,z\n1,2,3\n1,2\n", ":3: 2 values for 3 columns");
  file_refused("x,y,z\n1,2,nan\n", ":2: not a finite number: nan");
  file_refused("x,y,z,qw,qx,qy,qz\n1,2,3,1,1,0,0\n", "the quaternion has length");
  file_refused("x,y,z,shape\n1,2,3,0.5\n", "shape 0.5 is not a whole number");
}

TEST_F(CaseFile, OverridesByIndexNameAndNewTable) {
  Case const c =
      load(minimal, {"grains.mix.count=7", "grains.0.diameter=0.2", "time.settle.after=0.8",
                     "gravity=", "grains.mix.shapes=[\"box:1:1:1\"]", "wall.floor.name=ground", "contact.0.friction="});
  EXPECT_EQ(c.grains.at(0).count, 7);
  EXPECT_EQ(c.grains[0].diameter, 0.2);
  EXPECT_EQ(c.grains[0].shapes, std::vector<std::string>{"box:1:1:1"});
  EXPECT_EQ(c.time.settle->after, 0.8);
  EXPECT_EQ(c.time.settle->damping, SettleCase{}.damping);
  EXPECT_FALSE(c.gravity.has_value());
  EXPECT_FALSE(c.contact.at(0).friction.has_value());
  EXPECT_EQ(c.wall.at(0).name, "ground");  // a bare word is a string
}

TEST_F(CaseFile, OverridesAreReportedAsSuch) {
  expect_one(refused(minimal, {"grains.mix.diameter=-1"}), {"--set: grains.mix.diameter: -1 is out of range"});
  expect_one(refused(minimal, {"time.ennd=2"}), {"--set: time.ennd: is an unknown key", "'end'"});
  expect_one(refused(minimal, {"grains.mxi.count=2"}),
             {"--set grains.mxi.count=2", "no entry 'mxi'", "did you mean 'mix'?"});
  expect_one(refused(minimal, {"time.end"}), {"--set time.end", "key=value"});
  expect_one(refused(minimal, {"time.end.x=3"}), {"--set time.end.x=3: 'time.end' is a number"});
}

TEST_F(CaseFile, LibrariesAreFoundNextToTheCaseThenInTheEnvironmentThenInShare) {
  std::string const text = std::string(minimal) + "[[library]]\nname = \"grains\"\nfile = \"lib/grains.h5\"\n";
  expect_one(refused(text), {"library.grains.file: 'lib/grains.h5' was not found; tried"});
  fs::create_directories(folder_ / "share");
  std::ofstream(folder_ / "share" / "grains.h5") << "x";
  fs::path const file = write(text);
  EXPECT_EQ(load_case(file, {}, folder_ / "share").library.at(0).file, fs::canonical(folder_ / "share/grains.h5"));
  fs::create_directories(folder_ / "env/lib");
  std::ofstream(folder_ / "env/lib/grains.h5") << "x";
  ASSERT_EQ(::setenv("SCREE_LIBRARY", (folder_ / "env").c_str(), 1), 0);
  EXPECT_EQ(load_case(file, {}, folder_ / "share").library.at(0).file, fs::canonical(folder_ / "env/lib/grains.h5"));
  fs::create_directories(folder_ / "lib");
  std::ofstream(folder_ / "lib/grains.h5") << "x";
  EXPECT_EQ(load_case(file, {}, folder_ / "share").library.at(0).file, fs::canonical(folder_ / "lib/grains.h5"));
  ::unsetenv("SCREE_LIBRARY");
}

}  // namespace
}  // namespace scree
