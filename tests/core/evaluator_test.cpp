// evaluator_test.cpp: the same grains as net, grid, mesh and formula: contact sets, threads, heights, refusals.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include "core/simulation_impl.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "tests/support/cases.h"
#include "tests/support/contact_sets.h"
#include "tests/support/shape_kinds.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

// A folder with a model file of the kinds that need one, and a cache of its own.
class Evaluators : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new fs::path(fs::temp_directory_path() / ("scree_evaluators_" + std::to_string(::getpid())));
    fs::create_directories(*folder);
    ::setenv("SCREE_CACHE", (*folder / "cache").c_str(), 1);
    for (char const* kind : {"single_net", "coded_net", "harmonics", "mesh", "grid"})
      write_model(*folder / (std::string(kind) + ".h5"), library_of_kind(kind));
  }
  static void TearDownTestSuite() {
    ::unsetenv("SCREE_CACHE");
    fs::remove_all(*folder);
    delete folder;
  }

  // The word for a kind in a case; the libraries it needs are added.
  static std::string word(std::string const& kind, Case& c) {
    if (kind == "sphere") return kind;
    if (kind == "ellipsoid") return "ellipsoid:1:0.8:0.6";
    if (kind == "box") return "box:1:0.8:0.6";
    bool const known =
        std::any_of(c.library.begin(), c.library.end(), [&](LibraryCase const& l) { return l.name == "l_" + kind; });
    if (!known) c.library.push_back({"l_" + kind, *folder / (kind + ".h5")});
    return "l_" + kind + ":*";
  }

  static GrainsCase evaluated(GrainsCase g, Evaluator evaluator) {
    g.evaluator = evaluator;
    g.grid_cells = 32;
    g.mesh_cells = 8;
    return g;
  }

  static std::string complaint(Case const& c) {
    try {
      Simulation(c, {});
    } catch (InputError const& e) {
      return e.what();
    }
    return "";
  }

  static fs::path* folder;
};
fs::path* Evaluators::folder = nullptr;

// All evaluators in one heap, against every node at every step; one and two threads.
TEST_F(Evaluators, NodeListsOfAMixtureGiveTheContactSetsOfBruteForceForAnyThreads) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.7;
  GrainsCase g = grains_at("sphere", {}, 0.1, 150);
  g.insert.kind = InsertCase::Kind::lattice;
  g.insert.orientation = Orientation::random;
  g.insert.velocity = {0.8, 0.4, -4};
  g.insert.box = {{0, 0, 0}, {0.34, 0.34, 1.2}};
  std::map<Evaluator, std::vector<std::string>> const mixture = {
      {Evaluator::net, {word("coded_net", c), word("harmonics", c), word("mesh", c), word("grid", c), "sphere"}},
      {Evaluator::grid, {word("coded_net", c), "box:1:0.8:0.6"}},
      {Evaluator::mesh, {word("single_net", c), "ellipsoid:1:0.8:0.6"}}};
  for (auto const& [evaluator, shapes] : mixture) {
    g.name = "group" + std::to_string(c.grains.size());
    g.shapes = shapes;
    g.count = static_cast<int>(shapes.size());
    c.grains.push_back(evaluated(g, evaluator));
  }
  c.wall = {open_box({0, 0, 0}, {0.34, 0.34, 2})};
  c.time.end = 0.035;
  Simulation lists(c, {}), brute(c, {.threads = 2, .brute_force = true});
  EXPECT_EQ(lists.plan().stages,
            (std::vector<std::string>{"bounds", "broad_phase", "node_gather", "sdf_net", "sdf_harmonics", "sdf_grid",
                                      "sdf_mesh", "sdf_analytic", "sphere_contacts", "contact_reduce", "gravity",
                                      "integrate", "watch"}));
  expect_same_contact_sets(lists, brute, 1000);
  EXPECT_LT(lists.impl().work.active.queries, brute.impl().work.active.queries / 10);
  EXPECT_EQ(lists.frame().orientation, brute.frame().orientation);
  // Nodes that stay inside get phi and gradient in one pass, brute force asks twice: the same bits either way.
  EXPECT_GT(lists.impl().work.active.fresh, 0);
  EXPECT_LT(lists.impl().work.active.fresh, brute.impl().work.active.fresh / 5);
  // What was timed is what the plan names.
  for (char const* stage : {"sdf_harmonics/evaluate", "sdf_grid/evaluate", "sdf_mesh/evaluate"})
    EXPECT_TRUE(std::any_of(lists.profile().entries().begin(), lists.profile().entries().end(),
                            [&](Profile::Entry const& e) { return e.name == stage && e.items > 0; }))
        << stage;
}

// A ball at rest on a floor. Closed form: m g = pi R kappa overlap^2.
TEST_F(Evaluators, ASphereSettlesAtOneHeightUnderEveryEvaluator) {
  double const d = 0.1, g = 9.81;
  auto const height = [&](std::string const& shape, Evaluator evaluator) {
    Case c = rock_case();
    c.gravity = Vec3{0, 0, -g};
    c.contact[0].damping_ratio = 0.7;
    c.grains = {evaluated(grains_at(shape, {{0, 0, d / 2}}, d, 2000), evaluator)};
    c.grains[0].grid_cells = 43;
    c.grains[0].mesh_cells = 16;
    c.wall = {floor_at(0)};
    c.time.end = 0.2;
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    return s.frame().position[0].z;
  };
  double const exact = height("sphere", Evaluator::net);
  double const sunk =
      std::sqrt(2650 * 3.141592653589793 / 6 * d * d * d * g / (3.141592653589793 * (d / 2) * 2.546479e10));
  EXPECT_NEAR(exact, d / 2 - sunk, 1e-9);
  EXPECT_EQ(height("sphere", Evaluator::analytic), exact);
  // On a plane a grain answers by where its nodes stand. 2,000 of them, 0.04 d apart, find contacts of 0.024 d across
  // to 1e-4 d; the grid adds what interpolation moves the pole by, the mesh its chords, up to s^2 / 8 R = 8e-4 d for
  // edges of s = 0.06 d.
  EXPECT_NEAR(height("ellipsoid:1:1:1", Evaluator::net), exact, 2e-4 * d);  // nodes without baking
  EXPECT_NEAR(height("sphere", Evaluator::grid), exact, 2e-4 * d);
  EXPECT_NEAR(height("sphere", Evaluator::mesh), exact, 8e-4 * d);
}

TEST_F(Evaluators, AStoredShapeIsUsedAsItIs) {
  Case c = rock_case();
  c.grains = {evaluated(grains_at(word("mesh", c), {{0, 0, 0}}, 0.1, 100), Evaluator::mesh)};
  Simulation s(c, {});
  EXPECT_EQ(s.impl().scene.library.mesh.at(0)->mesh().triangle.size(), l_prism().triangle.size());
  EXPECT_EQ(s.plan().stages[3], "sdf_mesh");
}

TEST_F(Evaluators, MeshFilesAreShapes) {
  write_mesh(*folder / "prism.stl", l_prism());
  TriangleMesh open = l_prism();
  open.triangle.pop_back();
  write_mesh(*folder / "open.stl", open);
  Case c = rock_case();
  c.grains = {grains_at("mesh:" + (*folder / "prism.stl").string(), {{0, 0, 0}}, 0.1, 100)};
  Simulation s(c, {});
  EXPECT_EQ(s.results_header().shape_name, std::vector<std::string>{"mesh:prism.stl"});
  EXPECT_NEAR(s.impl().scene.mass[0], 2650 * 3.141592653589793 / 6 * 1e-3, 1e-6);
  c.grains[0].shapes = {"mesh:" + (*folder / "open.stl").string()};
  std::string const said = complaint(c);
  EXPECT_NE(said.find("open.stl"), std::string::npos) << said;
  EXPECT_NE(said.find("scree-shape import"), std::string::npos) << said;
  c.grains[0].shapes = {"mesh:" + (*folder / "none.stl").string()};
  EXPECT_NE(complaint(c).find("none.stl"), std::string::npos) << complaint(c);
}

TEST_F(Evaluators, TheSameShapeTwiceHasTwoNamesInTheResults) {
  Case c = rock_case();
  GrainsCase a = grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 0}}, 0.1, 100);
  GrainsCase b = evaluated(grains_at("ellipsoid:1:0.8:0.6", {{1, 0, 0}}, 0.1, 100), Evaluator::grid);
  b.name = "other";
  c.grains = {a, b};
  ResultsHeader const header = Simulation(c, {}).results_header();
  EXPECT_EQ(header.shape_name, (std::vector<std::string>{"ellipsoid:1:0.8:0.6", "ellipsoid:1:0.8:0.6 #2"}));
  EXPECT_EQ(problems(header.library), std::vector<std::string>{});
}

TEST_F(Evaluators, FormulasAreAskedOfFormulasOnly) {
  Case c = rock_case();
  c.grains = {evaluated(grains_at(word("coded_net", c), {{0, 0, 0}}, 0.1, 100), Evaluator::analytic)};
  EXPECT_NE(complaint(c).find("needs formulas"), std::string::npos) << complaint(c);
  EXPECT_NE(complaint(c).find("stored as a net"), std::string::npos) << complaint(c);
}

}  // namespace
}  // namespace scree
