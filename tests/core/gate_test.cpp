// gate_test.cpp: no network runs ungated: every broken figure is refused by name, with value, limit and the way out.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/certificate_gate.h"
#include "core/simulation.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

Shape good_network() {
  Shape shape;
  shape.name = "rock";
  shape.kind = ShapeKind::net;
  Certificate& c = shape.certificate;
  c.gradient_p1 = 0.9, c.gradient_p99 = 1.1;
  c.components = 1, c.euler = 2;
  c.falling = 1e-3, c.gap = 1e-3;
  c.mae = 1e-3, c.hausdorff = 1e-2, c.volume_error = 1e-3, c.inertia_error = 3e-3;
  return shape;
}

bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

TEST(Gate, GoodNetworksAndFormulasPass) {
  EXPECT_TRUE(gate_problems(good_network(), "rock.h5", {}).empty());
  Shape formula;
  formula.name = "sphere";
  EXPECT_TRUE(gate_problems(formula, "", {}).empty());
}

TEST(Gate, EachBrokenFigureIsRefusedByName) {
  struct Broken {
    char const* name;
    void (*spoil)(Certificate&);
    char const* value;
    char const* allowed;
  };
  Broken const broken[] = {
      {"components", [](Certificate& c) { c.components = 2, c.euler = 4; }, "is 2", "allows 1"},
      {"handles", [](Certificate& c) { c.euler = -2; }, "is 2", "allows 0"},
      {"falling", [](Certificate& c) { c.falling = 0.3; }, "is 0.3", "allows 0.05"},
      {"gap", [](Certificate& c) { c.gap = 0.02; }, "is 0.02", "allows 0.005"},
      {"mae", [](Certificate& c) { c.mae = 0.04; }, "is 0.04", "allows 0.01"},
      {"hausdorff", [](Certificate& c) { c.hausdorff = 0.2; }, "is 0.2", "allows 0.05"},
      {"volume", [](Certificate& c) { c.volume_error = 0.03; }, "is 0.03", "allows 0.01"},
      {"inertia", [](Certificate& c) { c.inertia_error = 0.05; }, "is 0.05", "allows 0.03"},
      {"gradient", [](Certificate& c) { c.gradient_p1 = 0.3; }, "from 0.3 to 1.1", "allows [0.5, 2]"},
      {"gradient", [](Certificate& c) { c.gradient_p99 = 2.5; }, "from 0.9 to 2.5", "allows [0.5, 2]"},
  };
  for (Broken const& b : broken) {
    Shape shape = good_network();
    b.spoil(shape.certificate);
    std::vector<std::string> const found = gate_problems(shape, "rock.h5", {});
    ASSERT_EQ(found.size(), 1u) << b.name;
    for (std::string const part : {"shape 'rock'", b.value, b.allowed})
      EXPECT_TRUE(contains(found[0], part)) << part << " | " << found[0];
    EXPECT_TRUE(contains(found[0], std::string("set limits.") + b.name + " in the case")) << found[0];
  }
}

TEST(Gate, EveryTableRowIsBroken) {  // a new limit needs its row above
  EXPECT_EQ(certificate_limits().size(), 8);
}

TEST(Gate, AllProblemsAtOnce) {
  Shape shape = good_network();
  shape.certificate.mae = shape.certificate.gap = shape.certificate.falling = 0.5;
  shape.certificate.gradient_p99 = 3;
  EXPECT_EQ(gate_problems(shape, "rock.h5", {}).size(), 4u);
}

TEST(Gate, TheCaseOverridesByName) {
  Shape shape = good_network();
  shape.certificate.mae = 0.04;
  LimitsCase limits;
  EXPECT_TRUE(limits_set(limits).empty());
  limits.mae = 0.05;
  EXPECT_TRUE(gate_problems(shape, "rock.h5", limits).empty());
  EXPECT_EQ(limits_set(limits), std::vector<std::string>{"limits.mae = 0.05 set by the case (default 0.01)"});
  limits.gradient_low = 0.7;
  EXPECT_EQ(limits_set(limits).size(), 2u);
}

// What phi alone tells must have been measured; what needs a truth is not asked of shapes that have none.
TEST(Gate, UnmeasuredNetworksAreSentToInspect) {
  Shape generated = good_network();
  Certificate& c = generated.certificate;
  c.mae = c.hausdorff = c.volume_error = c.inertia_error = c.gap = -1;
  EXPECT_TRUE(gate_problems(generated, "rock.h5", {}).empty());
  Shape bare = good_network();
  bare.certificate = {};
  std::vector<std::string> const found = gate_problems(bare, "models/rock.h5", {});
  ASSERT_EQ(found.size(), 1u);
  for (std::string const part :
       {"gradient, components, handles, falling: never", "scree-shape inspect rock.h5 --write"})
    EXPECT_TRUE(contains(found[0], part)) << found[0];
}

TEST(Gate, LimitsAreReadCheckedAndEchoed) {
  std::filesystem::path const file = std::filesystem::temp_directory_path() / "scree_gate_case.toml";
  std::ofstream(file) << R"([time]
end = 0.1
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { kappa = 1e9 }
[limits]
components = 2
mae = 0.02
falling = 0.125
)";
  Case const c = load_case(file, {});
  EXPECT_EQ(c.limits.components, 2);
  EXPECT_EQ(c.limits.mae, 0.02);
  EXPECT_EQ(c.limits.falling, 0.125);
  EXPECT_EQ(c.limits.gap, LimitsCase{}.gap);
  std::ofstream(file) << to_toml(c);
  EXPECT_EQ(load_case(file, {}).limits.falling, 0.125);
  try {
    load_case(file, {"limits.gap=-1"});
    FAIL() << "a negative limit was accepted";
  } catch (InputError const& e) {
    EXPECT_TRUE(contains(e.problems[0], "limits.gap")) << e.problems[0];
  }
  std::filesystem::remove(file);
}

TEST(Gate, ACaseWithTighterLimitsRefusesAShippedGrainByName) {
  Case c = testing::rock_case();
  c.library = {{"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  c.grains = {testing::grains_at("grains:ballast/0", {{0, 0, 0}})};
  c.limits.gradient_low = 0.95;
  try {
    Simulation(c, {});
    FAIL() << "ballast's |grad phi| of about 0.8 at its edges passed a limit of 0.95";
  } catch (InputError const& e) {
    ASSERT_EQ(e.problems.size(), 1u);
    EXPECT_TRUE(contains(e.problems[0], "ballast/0")) << e.problems[0];
    EXPECT_TRUE(contains(e.problems[0], "limits.gradient")) << e.problems[0];
  }
}

}  // namespace
}  // namespace scree
