// case_problems_test.cpp: what case files are refused for, and with which words.
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <tuple>

#include "core/case.h"
#include "tests/core/case_file_fixture.h"

namespace scree {
namespace {

using namespace testing;

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
  ASSERT_EQ(problems.size(), 3u) << ::testing::PrintToString(problems);
  EXPECT_NE(problems[0].find("density"), std::string::npos);
  EXPECT_NE(problems[1].find("frction"), std::string::npos);
  EXPECT_NE(problems[2].find("count"), std::string::npos);
}

TEST(CaseProblems, ApiUsersGetTheSameWords) {
  Case c;
  c.material = {{"rock", -1}};
  std::vector<std::string> const found = problems(c);
  ASSERT_EQ(found.size(), 1u) << ::testing::PrintToString(found);
  EXPECT_NE(found[0].find("material.rock.density: -1 is out of range"), std::string::npos);
}

}  // namespace
}  // namespace scree
