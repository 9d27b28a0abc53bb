// case_test.cpp: the case file: what it means, what it refuses and with which words.
// SPDX-License-Identifier: Apache-2.0
#include "core/case.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

namespace {

using namespace scree;
namespace fs = std::filesystem;

char const* const minimal = R"([case]
name = "drop"
[time]
end = 1.5
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e6, at_overlap = 0.01 }
friction = 0.5
damping = { ratio = 0.7 }
[[grains]]
name = "mix"
material = "rock"
shapes = ["sphere"]
count = 5
diameter = 0.1
insert = { kind = "lattice", box = [[0, 0, 0], [1, 1, 4]] }
[[wall]]
name = "floor"
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "rock"
)";

class CaseFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_case_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(std::string const& text, std::string const& name = "case.toml") {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Case load(std::string const& text, std::vector<std::string> const& overrides = {}) {
    return load_case(write(text), overrides);
  }
  // The problems of `text`, without the folder's name.
  std::vector<std::string> refused(std::string const& text, std::vector<std::string> const& overrides = {}) {
    try {
      load(text, overrides);
    } catch (InputError const& error) {
      std::vector<std::string> lines = error.problems;
      std::string const prefix = folder_.string() + "/";
      for (std::string& line : lines)
        if (line.starts_with(prefix)) line = line.substr(prefix.size());
      return lines;
    }
    return {};
  }
  // Expects exactly one problem that contains every one of `parts`.
  void expect_one(std::vector<std::string> const& problems, std::vector<std::string> const& parts) {
    ASSERT_EQ(problems.size(), 1u) << testing::PrintToString(problems);
    for (std::string const& part : parts)
      EXPECT_NE(problems[0].find(part), std::string::npos) << problems[0] << "\nlacks: " << part;
  }

  fs::path folder_;
};

// `text` with the first `from` replaced by `to`.
std::string with(std::string text, std::string const& from, std::string const& to) {
  std::size_t const at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("test text lacks: " + from);
  return text.replace(at, from.size(), to);
}

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

TEST_F(CaseFile, MissingFileIsNamed) {
  try {
    load_case(folder_ / "absent.toml", {});
    FAIL() << "a missing file was accepted";
  } catch (InputError const& error) {
    EXPECT_NE(std::string(error.what()).find("absent.toml: no such case file"), std::string::npos);
  }
}

TEST_F(CaseFile, SyntaxErrorComesAloneWithLineAndColumn) {
  // Line 2 is damaged; the unknown key after it must not be mentioned.
  expect_one(refused("[case]\nname = \"a\nfriktion = 1\n"), {"case.toml:2:", "TOML syntax"});
}

TEST_F(CaseFile, UnknownKeyNamesLineAndNearest) {
  expect_one(refused(with(minimal, "friction = 0.5", "frction = 0.5")),
             {"case.toml:13: contact.0.frction: is an unknown key", "did you mean 'friction'?", "tangential_ratio"});
  expect_one(refused(with(minimal, "[gravity]", "[gravty]")), {"case.toml:5: gravty: is an unknown key", "'gravity'"});
}

TEST_F(CaseFile, WrongTypesAreNamed) {
  expect_one(refused(with(minimal, "density = 2650", "density = \"heavy\"")),
             {"case.toml:9: material.rock.density: must be a number, not a string"});
  expect_one(refused(with(minimal, "count = 5", "count = 5.5")), {"grains.mix.count: must be a whole number"});
  expect_one(refused(with(minimal, "point = [0, 0, 0]", "point = [0, 0]")),
             {"wall.floor.point", "three numbers", "2 values"});
  expect_one(refused(with(minimal, "[[wall]]", "[wall]")), {"wall: must be a list of tables, written [[wall]]"});
}

TEST_F(CaseFile, MissingKeysAreNamed) {
  expect_one(refused(with(minimal, "density = 2650\n", "")), {"case.toml:7: material.rock.density: is missing"});
  expect_one(refused(with(minimal, "normal = { stiffness = 2e6, at_overlap = 0.01 }\n", "")),
             {"contact.0.normal: is missing"});
}

TEST_F(CaseFile, PhysicalRangesHaveReasons) {
  expect_one(refused(with(minimal, "density = 2650", "density = -2650")),
             {"case.toml:9: material.rock.density: -2650 is out of range: must be > 0", "kg/m3"});
  expect_one(refused(with(minimal, "friction = 0.5", "friction = -0.1")),
             {"contact.0.friction: -0.1", "must be >= 0", "drive the motion"});
  expect_one(refused(with(minimal, "ratio = 0.7", "restitution = 1.2")),
             {"restitution: 1.2", "<= 1", "energy would be made"});
  expect_one(refused(with(minimal, "end = 1.5", "end = 1.5\nsafety = 1.5")), {"time.safety: 1.5", "unstable"});
  expect_one(refused(with(minimal, "end = 1.5", "end = 1.5\nstep = 0")), {"time.step: 0", "must be > 0"});
  expect_one(refused(with(minimal, "diameter = 0.1", "diameter = nan")), {"grains.mix.diameter: nan"});
  expect_one(refused(with(minimal, "count = 5", "count = -1")), {"grains.mix.count: -1"});
  expect_one(refused(with(minimal, "normal = [0, 0, 1]", "normal = [0, 0, 0]")), {"wall.floor.normal", "free space"});
}

TEST_F(CaseFile, ExclusiveKeys) {
  expect_one(refused(with(minimal, "{ ratio = 0.7 }", "{ ratio = 0.7, restitution = 0.5 }")),
             {"exactly one of ratio and restitution"});
  expect_one(refused(with(minimal, "{ ratio = 0.7 }", "{}")), {"exactly one of ratio and restitution"});
  expect_one(refused(with(minimal, "{ stiffness = 2e6,", "{ kappa = 2.5e10,")), {"either kappa", "not both"});
}

TEST_F(CaseFile, EachLawHasItsOwnNormalKeys) {
  std::string const old = "normal = { stiffness = 2e6, at_overlap = 0.01 }";
  auto const law = [&](std::string const& name, std::string const& keys) {
    return with(minimal, old, "law = \"" + name + "\"\nnormal = { " + keys + " }");
  };
  ContactCase const linear = load(law("linear", "stiffness = 1e5, onset = 2e-3")).contact.at(0);
  EXPECT_EQ(linear.law, ContactLaw::linear);
  EXPECT_EQ(std::tie(linear.stiffness, linear.onset), std::make_tuple(1e5, 2e-3));
  ContactCase const hertz = load(law("hertz", "youngs_modulus = 7e10, poisson_ratio = 0.2")).contact.at(0);
  EXPECT_EQ(hertz.law, ContactLaw::hertz);
  EXPECT_EQ(std::tie(hertz.youngs_modulus, hertz.poisson_ratio), std::make_tuple(7e10, 0.2));
  expect_one(refused(law("linear", "kappa = 1e9, stiffness = 1e5")), {"normal.kappa: has a meaning beside law"});
  expect_one(refused(law("linear", "onset = 1e-3")), {"normal.stiffness: is missing", "k_n"});
  expect_one(refused(law("linear", "stiffness = 1e5, onset = 0")), {"normal.onset: 0 is out of range"});
  expect_one(refused(law("hertz", "youngs_modulus = 7e10")), {"normal.poisson_ratio: is missing"});
  expect_one(refused(law("hertz", "youngs_modulus = 0, poisson_ratio = 0.2")), {"youngs_modulus: 0", "must be > 0"});
  for (char const* nu : {"-1.0", "0.5", "nan"})
    expect_one(refused(law("hertz", std::string("youngs_modulus = 7e10, poisson_ratio = ") + nu)),
               {"normal.poisson_ratio: ", "must be > -1 and < 0.5"});
  expect_one(refused(law("winkler", "stiffness = 1e5, poisson_ratio = 0.2")),
             {"normal.poisson_ratio: has a meaning beside law = \"hertz\" only"});
  expect_one(refused(law("herz", "stiffness = 1e5")), {"'herz' is unknown", "'hertz'"});
}

TEST_F(CaseFile, RollingResistanceHasItsRanges) {
  auto const rolling = [&](std::string const& keys) {
    return with(minimal, "friction = 0.5", "friction = 0.5\nrolling = { " + keys + " }");
  };
  RollingCase const given = *load(rolling("friction = 0.1")).contact.at(0).rolling;
  EXPECT_EQ(std::tie(given.friction, given.stiffness_ratio, given.damping), std::make_tuple(0.1, 2.25, 0.3));
  expect_one(refused(rolling("")), {"rolling.friction: is missing"});
  expect_one(refused(rolling("friction = -0.1")), {"rolling.friction: -0.1", "must be >= 0", "drive the rolling"});
  expect_one(refused(rolling("friction = 0.1, damping = 1.5")), {"rolling.damping: 1.5", "<= 1"});
  expect_one(refused(rolling("friction = 0.1, stiffness_ratio = 0")), {"rolling.stiffness_ratio: 0", "must be > 0"});
}

TEST_F(CaseFile, CohesionHasItsRanges) {
  auto const cohesion = [&](std::string const& keys) {
    return with(minimal, "friction = 0.5", "friction = 0.5\ncohesion = { " + keys + " }");
  };
  CohesionCase const given = *load(cohesion("traction = 1e4, range = 1e-4")).contact.at(0).cohesion;
  EXPECT_EQ(std::tie(given.traction, given.range), std::make_tuple(1e4, 1e-4));
  expect_one(refused(cohesion("traction = 1e4")), {"cohesion.range: is missing"});
  expect_one(refused(cohesion("traction = 1e4, range = -1e-4")), {"cohesion.range: -0.0001", "must be >= 0"});
  expect_one(refused(cohesion("traction = -1, range = 1e-4")), {"cohesion.traction: -1", "must be >= 0", "repel"});
}

TEST_F(CaseFile, InsertionThatCannotFitIsRefused) {
  // floor(1/0.1) = 10 cells a side (as floating point has it), 40 layers: 4,000 places.
  expect_one(refused(with(minimal, "count = 5", "count = 5000")), {"grains.mix.insert.box", "not 5000"});
  expect_one(refused(with(minimal, "[1, 1, 4]", "[1, 1, 0]")), {"insert.box", "above the first"});
}

TEST_F(CaseFile, UnknownNamesOfferTheNearest) {
  expect_one(refused(with(minimal, "kind = \"plane\"", "kind = \"plain\"")),
             {"'plain' is unknown", "did you mean 'plane'?"});
  expect_one(refused(with(minimal, "[0, 0, 1]\nmaterial = \"rock\"", "[0, 0, 1]\nmaterial = \"rocc\"")),
             {"wall.floor.material: unknown material 'rocc'", "did you mean 'rock'?", "defined: rock"});
  expect_one(refused(with(minimal, "shapes = [\"sphere\"]", "shapes = [\"grians:ballast/*\"]")),
             {"unknown library 'grians'"});
  expect_one(refused(with(minimal, "shapes = [\"sphere\"]", "shapes = [\"spere\"]")),
             {"unknown shape 'spere'", "'sphere'"});
}

TEST_F(CaseFile, BuiltInShapesAreChecked) {
  expect_one(refused(with(minimal, "\"sphere\"", "\"ellipsoid:1:0.8\"")), {"it takes three axes"});
  expect_one(refused(with(minimal, "\"sphere\"", "\"box:1:x:1\"")), {"not a number: x"});
  expect_one(refused(with(minimal, "\"sphere\"", "\"superellipsoid:1:1:1:2.5\"")), {"exponents must be in 0.1..1.9"});
  EXPECT_EQ(
      load(with(minimal, "\"sphere\"", "\"superellipsoid:1:0.8:0.6:0.5\", \"box:1:1:2\"")).grains.at(0).shapes.size(),
      2u);
}

TEST_F(CaseFile, UnsupportedKeysAreRefusedByName) {
  expect_one(refused(with(minimal, "count = 5", "count = 5\ngroup = \"a\"")), {"group: is not supported"});
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

TEST_F(CaseFile, EffectsOnBodiesAreJudged) {
  std::string const drag = std::string(minimal) + "[drag]\ndensity = 1.2\ncoefficient = 0.5\n";
  expect_one(refused(drag, {"drag.coefficient=-1"}), {"drag.coefficient: -1", "drive the motion"});
  expect_one(refused(drag, {"drag.density=nan"}), {"drag.density: nan", "must be >= 0"});
  expect_one(refused(with(drag, "coefficient = 0.5\n", "")), {"drag.coefficient: is missing"});
  expect_one(refused(minimal, {"damping.rate=-2"}), {"damping.rate: -2", "add energy"});
  std::string const force = std::string(minimal) + "[[force]]\nname = \"push\"\ngrains = \"mix\"\nforce = [1, 0, 0]\n";
  expect_one(refused(with(force, "grains = \"mix\"", "grains = \"mxi\"")),
             {"force.push.grains: unknown grains 'mxi'", "did you mean 'mix'?"});
  expect_one(refused(with(force, "force = [1, 0, 0]\n", "")), {"force.push.force: is missing"});
  expect_one(refused(force, {"force.push.start=2", "force.push.stop=1"}), {"force.push.stop: 1 s must lie after"});
  expect_one(refused(force, {"force.push.start=1", "force.push.table=[[0, 1]]"}), {"either a table or start"});
  expect_one(refused(force, {"force.push.table=[[1, 1], [0, 1]]"}), {"times must ascend"});
  expect_one(refused(force, {"force.push.table=[]"}), {"at least one [time, factor]"});
  expect_one(refused(force + "[[force]]\nname = \"push\"\ngrains = \"mix\"\ntorque = [1, 0, 0]\n"),
             {"'push' is used twice"});
}

TEST_F(CaseFile, TouchingMaterialsNeedALaw) {
  std::string const text = with(minimal, "[[contact]]", "[[material]]\nname = \"steel\"\ndensity = 7800\n[[contact]]");
  expect_one(refused(with(text, "normal = [0, 0, 1]\nmaterial = \"rock\"", "normal = [0, 0, 1]\nmaterial = \"steel\"")),
             {"'rock' and 'steel' can touch", "[[contact]]"});
  EXPECT_TRUE(refused(text).empty());  // a material that nothing uses needs none
}

TEST_F(CaseFile, AllProblemsComeAtOnceInFileOrder) {
  std::string text = with(minimal, "density = 2650", "density = -1");
  text = with(text, "friction = 0.5", "frction = 0.5");
  text = with(text, "count = 5", "count = \"many\"");
  std::vector<std::string> const problems = refused(text);
  ASSERT_EQ(problems.size(), 3u) << testing::PrintToString(problems);
  EXPECT_NE(problems[0].find("density"), std::string::npos);
  EXPECT_NE(problems[1].find("frction"), std::string::npos);
  EXPECT_NE(problems[2].find("count"), std::string::npos);
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

// No member may be lost on the way through text: every one differs from its default here.
Case unusual_case(fs::path const& library) {
  Case c;
  c.name = "odd \"name\" \\ \x01";
  c.seed = 77;
  c.time = {1.0 / 3, 0.1 + 0.02, 0.25, SettleCase{4.5, 0.01, 3e-9, 0.07}};
  c.gravity = Vec3{1e-300, -0.5, 9.81};
  c.library = {{"grains", library}};
  c.material = {{"rock", 2650.5}, {"steel", 7.8e3}, {"wood", 700}};
  c.contact.resize(3);
  c.contact[0] = {{"rock", "rock"}, ContactLaw::winkler, {}, 3e6, 0.02, 0.75, 0.4, 0.6, {}};
  c.contact[1] = {{"rock", "steel"}, ContactLaw::winkler, 2.5e10, 2e6, 0.01, 0.5, {}, {}, 0.5};
  c.contact[2] = {{"steel", "steel"}, ContactLaw::winkler, 1e20, 2e6, 0.01, 0.5, {}, {}, {}};
  c.contact.resize(5);
  c.contact[3] = {{"rock", "wood"}, ContactLaw::linear, {}, 3e5, 0.02, 0.75, 0.4, 0.6, {}, 3e-3};
  c.contact[3].rolling = RollingCase{0.2, 1.5, 0.25};
  c.contact[4] = {{"wood", "wood"}, ContactLaw::hertz, {}, 2e6, 0.03, 0.5, {}, {}, 0.5, 1e-3, 7.1e10, -0.25};
  c.contact[4].cohesion = CohesionCase{1.5e4, 2e-4};
  c.grains.resize(5);
  c.grains[0] = {"mix", "rock", {"grains:ballast/*", "sphere"}, Evaluator::analytic, 123, 4, 0.05, {}};
  c.grains[0].insert = {InsertCase::Kind::lattice,
                        {{0, 0.1, 0.2}, {1, 2, 3}},
                        Orientation::aligned,
                        {1, 2, 3},
                        {4, 5, 6},
                        {},
                        {},
                        0,
                        0,
                        {},
                        {},
                        {},
                        {}};
  c.grains[1] = {"two", "steel", {"sphere"}, Evaluator::net, 1000, 2, 0.1, {}};
  c.grains[1].insert = {InsertCase::Kind::list,
                        {},
                        Orientation::random,
                        {},
                        {},
                        {{0.1, 0, 0}, {2, 3, 4}},
                        {{0.6, 0.8, 0, 0}, {0, 0, 0, 1}},
                        0,
                        0,
                        {},
                        {},
                        {},
                        {}};
  c.grains[2] = {"three", "steel", {"sphere"}, Evaluator::net, 1000, 1, 0.1, {}};
  c.grains[2].insert = {
      InsertCase::Kind::list, {}, Orientation::aligned, {}, {}, {{9, 9, 9}}, {}, 0, 0, {}, {}, {}, {}};
  c.grains[3] = {"four", "steel", {}, Evaluator::grid, 1000, 1, 0.1, {}};
  c.grains[3].sample = SampleCase{"grains", "bal\"last", 1.75, {0.6, 0.9}, {}, {0.1, 0.2}, {0.3, 1}, {0.4, INFINITY}};
  c.grains[3].least_diameter = 0.05;
  c.grains[4] = {"five", "steel", {}, Evaluator::net, 1000, 1, 0.1, {}};
  c.grains[4].interpolate = InterpolateCase{"grains", "ballast/0", "sand/3", 0.25, 0.75};
  for (int i : {3, 4}) c.grains[i].insert = c.grains[2].insert;
  c.wall.resize(8);
  char const* const wall_name[8] = {"floor", "bin", "block", "drum", "rod", "hopper", "blade", "hill"};
  for (int i = 0; i < 8; ++i) c.wall[i].name = wall_name[i], c.wall[i].material = i % 2 ? "rock" : "steel";
  c.wall[0].point = {1, 2, 3}, c.wall[0].normal = {0, 0.6, 0.8};
  for (int i : {1, 2}) c.wall[i].kind = WallKind::box, c.wall[i].min = {-1, -2, -3}, c.wall[i].max = {1, 2, 3};
  c.wall[1].open = {"+z", "-x"};
  c.wall[2].inside = false;
  c.wall[3].kind = WallKind::cylinder, c.wall[3].radius = 0.7, c.wall[3].open = {"to"};
  c.wall[4].kind = WallKind::capsule, c.wall[4].radius = 0.1;
  c.wall[5].kind = WallKind::cone, c.wall[5].radius_from = 0.1, c.wall[5].radius_to = 2, c.wall[5].thickness = 0.03;
  for (int i : {3, 4, 5}) c.wall[i].from = {1, 0, 0.1}, c.wall[i].to = {3, 4, 5};
  c.wall[6].kind = WallKind::mesh, c.wall[6].thickness = 0.01, c.wall[6].scale = 1e-3, c.wall[6].shift = {1, 2, 0.3};
  c.wall[7].kind = WallKind::terrain;
  for (int i : {6, 7}) c.wall[i].file = library;  // any file that exists: it is not opened
  MotionCase turn, table, slide;
  turn.axis = {0, 1, 0.5}, turn.through = {1, 2, 3}, turn.rate = -0.3, turn.start = 0.5, turn.end = 9;
  table = turn;
  table.time = {0, 1, 2.5}, table.rates = {1, 0, 0.1}, table.rate = 0, table.start = 0, table.end = MotionCase{}.end;
  slide.kind = MotionKind::translation;
  slide.time = {0, 0.1}, slide.velocities = {{1, 2, 3}, {0, 0, 0.5}};
  c.wall[3].motion = turn, c.wall[4].motion = table, c.wall[6].motion = slide;
  c.output = {0.125, true};
  c.checkpoint = CheckpointCase{0.75, 5};
  c.limits = {0.03, 0.6, 1.9, 2e-3};
  return c;
}

void expect_same(InsertCase const& a, InsertCase const& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.box.min, b.box.min);
  EXPECT_EQ(a.box.max, b.box.max);
  EXPECT_EQ(a.orientation, b.orientation);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.spin, b.spin);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.quaternion, b.quaternion);
}

void expect_same(GrainsCase const& a, GrainsCase const& b) {
  EXPECT_EQ(std::tie(a.name, a.material, a.shapes, a.evaluator, a.nodes, a.count, a.diameter),
            std::tie(b.name, b.material, b.shapes, b.evaluator, b.nodes, b.count, b.diameter));
  EXPECT_EQ(a.least_diameter, b.least_diameter);
  EXPECT_EQ(a.sample, b.sample);
  EXPECT_EQ(a.interpolate, b.interpolate);
  expect_same(a.insert, b.insert);
}

void expect_same(ContactCase const& a, ContactCase const& b) {
  EXPECT_EQ(std::tie(a.pair, a.law, a.kappa, a.tangential_ratio, a.friction, a.damping_ratio, a.restitution),
            std::tie(b.pair, b.law, b.kappa, b.tangential_ratio, b.friction, b.damping_ratio, b.restitution));
  if (a.kappa) return;  // stiffness is unused beside kappa
  EXPECT_EQ(std::tie(a.stiffness, a.at_overlap, a.onset), std::tie(b.stiffness, b.at_overlap, b.onset));
  ASSERT_EQ(a.rolling.has_value(), b.rolling.has_value());
  if (a.rolling)
    EXPECT_EQ(std::tie(a.rolling->friction, a.rolling->stiffness_ratio, a.rolling->damping),
              std::tie(b.rolling->friction, b.rolling->stiffness_ratio, b.rolling->damping));
  ASSERT_EQ(a.cohesion.has_value(), b.cohesion.has_value());
  if (a.cohesion)
    EXPECT_EQ(std::tie(a.cohesion->traction, a.cohesion->range), std::tie(b.cohesion->traction, b.cohesion->range));
  EXPECT_EQ(std::tie(a.youngs_modulus, a.poisson_ratio), std::tie(b.youngs_modulus, b.poisson_ratio));
}

void expect_same(WallCase const& a, WallCase const& b) {
  EXPECT_EQ(std::tie(a.name, a.material, a.kind, a.open), std::tie(b.name, b.material, b.kind, b.open));
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
  EXPECT_EQ(std::tie(a.inside, a.radius, a.radius_from, a.radius_to, a.thickness, a.file, a.scale),
            std::tie(b.inside, b.radius, b.radius_from, b.radius_to, b.thickness, b.file, b.scale));
  EXPECT_EQ(a.from, b.from);
  EXPECT_EQ(a.to, b.to);
  EXPECT_EQ(a.shift, b.shift);
  ASSERT_EQ(a.motion.has_value(), b.motion.has_value());
  if (!a.motion) return;
  MotionCase const &m = *a.motion, &n = *b.motion;
  EXPECT_EQ(std::tie(m.kind, m.rate, m.start, m.end, m.time, m.rates, m.velocities),
            std::tie(n.kind, n.rate, n.start, n.end, n.time, n.rates, n.velocities));
  EXPECT_EQ(m.axis, n.axis);
  EXPECT_EQ(m.through, n.through);
}

template <class T>
void expect_same(std::vector<T> const& a, std::vector<T> const& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) expect_same(a[i], b[i]);
}

TEST_F(CaseFile, EchoLoadsBackToTheSameCase) {
  fs::path const library = write("x", "grains.h5");
  Case const a = unusual_case(fs::canonical(library));
  ASSERT_TRUE(problems(a).empty()) << testing::PrintToString(problems(a));
  Case const b = load(to_toml(a));
  EXPECT_EQ(std::tie(a.name, a.seed), std::tie(b.name, b.seed));
  EXPECT_EQ(std::tie(a.time.end, a.time.step, a.time.safety), std::tie(b.time.end, b.time.step, b.time.safety));
  EXPECT_EQ(
      std::tie(a.time.settle->damping, a.time.settle->after, a.time.settle->kinetic_per_grain, a.time.settle->hold),
      std::tie(b.time.settle->damping, b.time.settle->after, b.time.settle->kinetic_per_grain, b.time.settle->hold));
  EXPECT_EQ(*a.gravity, *b.gravity);
  EXPECT_EQ(std::tie(a.library.at(0).name, a.library[0].file), std::tie(b.library.at(0).name, b.library[0].file));
  ASSERT_EQ(b.material.size(), 3u);
  EXPECT_EQ(std::tie(a.material[1].name, a.material[1].density), std::tie(b.material[1].name, b.material[1].density));
  expect_same(a.contact, b.contact);
  expect_same(a.grains, b.grains);
  expect_same(a.wall, b.wall);
  EXPECT_EQ(std::tie(a.output.every, a.output.paraview), std::tie(b.output.every, b.output.paraview));
  EXPECT_EQ(std::tie(a.checkpoint->every, a.checkpoint->keep), std::tie(b.checkpoint->every, b.checkpoint->keep));
  EXPECT_EQ(std::tie(a.limits.overlap, a.limits.gradient_low, a.limits.gradient_high, a.limits.ledger),
            std::tie(b.limits.overlap, b.limits.gradient_low, b.limits.gradient_high, b.limits.ledger));
  EXPECT_EQ(to_toml(a), to_toml(b));
}

TEST(CaseProblems, ApiUsersGetTheSameWords) {
  Case c;
  c.material = {{"rock", -1}};
  std::vector<std::string> const found = problems(c);
  ASSERT_EQ(found.size(), 1u) << testing::PrintToString(found);
  EXPECT_NE(found[0].find("material.rock.density: -1 is out of range"), std::string::npos);
}

}  // namespace
