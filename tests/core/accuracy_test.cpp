// accuracy_test.cpp: [accuracy]: meters of contact errors, what is picked, what the case gives, the promise.
// SPDX-License-Identifier: Apache-2.0
#include "core/accuracy.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include "core/case_text.h"
#include "core/contact_errors.h"
#include "core/figure_cache.h"
#include "core/impulse_error.h"
#include "core/simulation.h"
#include "shapes/analytic_shapes.h"
#include "shapes/whole_file.h"
#include "tools/promise.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

int constexpr few_points = 8000;  // of covers: within 2 % of a force in contacts 1 % d deep, 0.5 % in those of 3 %

struct Body {
  Library library;
  explicit Body(std::string const& word) { library.shape = {builtin_shape(word)}; }
  Shape const& shape() const { return library.shape[0]; }
};

PressureLaw law_of(ContactLaw kind, double modulus = 1) {
  PressureLaw law;
  law.kind = kind, law.modulus = modulus, law.onset = 1e-4;
  return law;
}

// The cache is a folder of this test's own, or none.
class Accuracy : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_accuracy_test_" + std::to_string(::getpid()));
    ::setenv("SCREE_CACHE", folder.c_str(), 1);
  }
  void TearDown() override {
    ::setenv("SCREE_CACHE", "", 1);
    fs::remove_all(folder);
  }
  fs::path folder;
};

// Costs of a machine on which a particle-step takes (nodes/1000) us and asks 10 (nodes/1000) times.
StepCosts even_costs() { return {"machine", {250, 1000}, {0.25, 1}, {2.5, 10}, 100}; }

AccuracyOptions quick() { return {1, few_points, 8000}; }

std::string const text = R"([time]
end = 1
[gravity]
acceleration = [0, 0, -9.81]
[accuracy]
budget = 0.1
overlap = 0.03
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { kappa = 2.5e10 }
[[grains]]
name = "balls"
material = "rock"
shapes = ["ellipsoid:1:1:1"]
evaluator = "analytic"
diameter = 0.1
insert = { kind = "list", position = [[0, 0, 0], [0, 0, 0.2]] }
)";

Case changed(std::string const& from, std::string const& to) {
  std::string other = text;
  if (!from.empty()) other.replace(other.find(from), from.size(), to);
  return case_from_text(other, "case.toml");
}

// Between balls of radius 1/2, x deep, each side's integral of phi grad phi is pi R x^2 with R = 1/4 to O(x).
TEST_F(Accuracy, ForcesOfBallsAreThoseOfSpheres) {
  Body const ball("ellipsoid:1:1:1");
  PhiBatch const phi = fast_phi(ball.library, ball.shape());
  SurfaceCover const dense = dense_cover(ball.library, ball.shape(), few_points);
  double const x = 0.01;
  for (ContactPose const& pose : draw_contacts(phi, ball.shape(), dense, 5, x, 7)) {
    EXPECT_NEAR(norm(pose.shift), 1 - x, 0.06 * x);
    double const deep = 1 - norm(pose.shift);
    Vec3 const exact = normalized(pose.shift) * (std::numbers::pi / 4 * deep * deep);
    Vec3 const force = contact_force({phi, phi}, ball.shape(), dense, pose, law_of(ContactLaw::winkler), 1);
    EXPECT_LT(norm(force - exact), 0.05 * norm(exact));
  }
}

TEST_F(Accuracy, ErrorsFallWithNodesAndKnowNeitherSizeNorStiffness) {
  Body const body("ellipsoid:1.5:1.25:1");
  auto const meter = [&](PressureLaw const& law, double d) {
    return ContactErrors(body.library, body.shape(), law, d, 0.03, few_points);
  };
  ContactErrors small = meter(law_of(ContactLaw::winkler), 0.1);
  double const few = small.at(250), many = small.at(1000);
  EXPECT_LT(many, 0.5 * few);  // about nodes^-1.3: a sixth
  EXPECT_LT(few, 1);
  EXPECT_GT(many, 1e-3);
  EXPECT_NEAR(meter(law_of(ContactLaw::winkler, 7e9), 3).at(250), few, 1e-9 * few);
}

TEST_F(Accuracy, ImpulsesAreOffBySecondOrderOfTheStep) {
  EXPECT_LT(impulse_error(ContactLaw::winkler, 0.5), 0.01);
  for (ContactLaw const law : {ContactLaw::winkler, ContactLaw::hertz, ContactLaw::linear}) {
    double const fine = impulse_error(law, 0.05), coarse = impulse_error(law, 0.4);
    EXPECT_GT(fine, 0);
    EXPECT_LT(8 * fine, coarse);  // at least first order, where the force starts with a kink
  }
  EXPECT_LT(50 * impulse_error(ContactLaw::winkler, 0.05), impulse_error(ContactLaw::winkler, 0.4));  // 8^2 = 64
}

TEST_F(Accuracy, CostsArePowersOfTheNodesAndDearerQueriesCount) {
  StepCosts const costs = even_costs();
  for (int n : {125, 250, 500, 1000, 4000}) {
    EXPECT_NEAR(costs.particle_step_us(n, 0), 1e-3 * n, 1e-12 * n);
    EXPECT_NEAR(costs.particle_step_us(n, 300), 1e-3 * n + 0.2 * 10 * 1e-3 * n, 1e-12 * n);
  }
}

TEST_F(Accuracy, FiguresAreKeptBitForBitAndDamageIsNoFigure) {
  std::vector<double> const figures = {1.0 / 3, 1e-300, 250, -0.1};
  EXPECT_TRUE(read_figures("key").empty());
  keep_figures("key", figures);
  EXPECT_EQ(read_figures("key"), figures);
  fs::copy_file(folder / "key.figures", folder / "other.figures");
  EXPECT_TRUE(read_figures("other").empty());  // of another key
  std::string damaged = read_whole_file(folder / "key.figures");
  damaged[damaged.find("250")] = '3';
  std::ofstream(folder / "key.figures") << damaged;
  EXPECT_TRUE(read_figures("key").empty());
  keep_figures("key", figures);
  EXPECT_EQ(read_figures("key"), figures);
  ::setenv("SCREE_CACHE", "", 1);
  keep_figures("key", {1});
  EXPECT_TRUE(read_figures("key").empty());
}

TEST_F(Accuracy, TheCaseIsReadJudgedAndWritten) {
  Case const c = changed("", "");
  ASSERT_TRUE(c.accuracy);
  EXPECT_EQ(c.accuracy->wanted(), 0.1);
  EXPECT_EQ(to_toml(case_from_text(to_toml(c), "case.toml")), to_toml(c));
  EXPECT_EQ(to_toml(c).find("\nnodes ="), std::string::npos);  // they are not known yet
  for (auto const& [word, budget] : {std::pair{"fast", 0.15}, {"balanced", 0.03}, {"reference", 0.003}}) {
    Case const named = changed("budget = 0.1", "preset = \"" + std::string(word) + "\"");
    EXPECT_EQ(named.accuracy->wanted(), budget);
    EXPECT_EQ(to_toml(case_from_text(to_toml(named), "case.toml")), to_toml(named));
  }
  EXPECT_THROW(changed("budget = 0.1", "budget = 0.1\npreset = \"fast\""), InputError);
  EXPECT_THROW(changed("budget = 0.1", ""), InputError);
  EXPECT_THROW(changed("evaluator = \"analytic\"", "storage = \"compact\""), InputError);
  EXPECT_THROW(Simulation(c, {}), InputError);
}

TEST_F(Accuracy, PicksTheFewestNodesThatKeepTheBudget) {
  Case const c = changed("", "");
  AccuracyPick const pick = pick_accuracy(c, even_costs(), quick());
  AccuracyPick::Entry const& e = pick.entry.at(0);
  EXPECT_LE(pick.error(), 0.1);
  EXPECT_EQ(pick.error(), e.error + pick.step_error);
  EXPECT_EQ(e.overlap, 0.03);
  EXPECT_GT(e.query_ns, 0);
  // At rest: F = pi R kappa x^2 = m g.
  double const mass = 2650 * std::numbers::pi / 6 * 1e-3;
  EXPECT_NEAR(e.resting, std::sqrt(mass * 9.81 / (std::numbers::pi * 0.025 * 2.5e10)) / 0.1, 1e-6);
  // A case like any other: as if the user had said so.
  Case plain = c;
  plain.accuracy.reset();
  plain.grains[0].nodes = e.nodes, plain.time.safety = pick.safety;
  EXPECT_EQ(to_toml(with_pick(c, pick)), to_toml(plain));
  EXPECT_EQ(to_toml(case_from_text(to_toml(plain), "case.toml")), to_toml(plain));
  Simulation const simulation(with_pick(c, pick), {});
  EXPECT_NEAR(simulation.time_step(), pick.step, 0.01 * pick.step);  // nodes are a few less than asked for
  // 2 bodies.
  double const us = even_costs().particle_step_us(e.nodes, e.query_ns);
  EXPECT_NEAR(pick.seconds, 2e-6 * us * std::ceil(1 / pick.step), 1e-9);
  // Of what was measured already: the same answer, and with half as many nodes the budget is not kept.
  AccuracyPick const again = pick_accuracy(c, even_costs(), quick());
  EXPECT_EQ(again.entry[0].error, e.error);
  EXPECT_EQ(again.seconds, pick.seconds);
  Case fewer = c;
  fewer.grains[0].nodes = e.nodes / 2, fewer.grains[0].nodes_given = true;
  EXPECT_GT(pick_accuracy(fewer, even_costs(), quick()).error(), 0.1);
}

TEST_F(Accuracy, WhatTheCaseGivesStays) {
  Case const c = changed("evaluator = \"analytic\"", "evaluator = \"analytic\"\nnodes = 300");
  AccuracyPick const pick = pick_accuracy(c, even_costs(), quick());
  EXPECT_EQ(pick.entry.at(0).nodes, 300);
  EXPECT_TRUE(pick.entry[0].given);
  EXPECT_GT(pick.error(), 0.1);
  std::vector<std::string> const words = pick_in_words(pick);
  EXPECT_NE(words.back().find("warning"), std::string::npos);
  EXPECT_TRUE(std::any_of(words.begin(), words.end(),
                          [](auto const& w) { return w.find("nodes = 300, as given") != std::string::npos; }));
  std::string both = text;
  both.replace(both.find("end = 1"), 7, "end = 1\nsafety = 0.07").replace(both.find("evaluator"), 0, "nodes = 300\n");
  Case const slow = case_from_text(both, "case.toml");
  AccuracyPick const given = pick_accuracy(slow, even_costs(), quick());
  EXPECT_EQ(given.safety, 0.07);
  EXPECT_TRUE(given.step_given);
}

TEST_F(Accuracy, WhatCannotBeKeptIsRefusedWithWhatCan) {
  Case const c = changed("budget = 0.1", "budget = 0.002");
  try {
    pick_accuracy(c, even_costs(), {1, few_points, 250});
    FAIL() << "taken";
  } catch (InputError const& error) {
    EXPECT_NE(std::string(error.what()).find("not reachable: 250 nodes on 'ellipsoid"), std::string::npos)
        << error.what();
  }
}

// Two settings of `scree cost --promise`, of formulas and grids, with budgets that the quick covers can judge.
TEST_F(Accuracy, KeepsItsPromiseInSettingsThatItHasNotSeen) {
  PromiseOptions o;
  o.accuracy = quick();
  o.costs = even_costs();
  std::vector<PromiseResult> results;
  for (int index : {0, 1}) {
    PromiseSetting s = promise_setting(1, index, false);
    s.budget = std::max(s.budget, 0.06);
    s.overlap = std::max(s.overlap, 0.02);
    results.push_back(try_promise(s, o, 100 + index));
    PromiseResult const& r = results.back();
    EXPECT_EQ(r.refused, "");
    EXPECT_TRUE(r.kept()) << s.shape << ' ' << r.p95 << " of " << s.budget;
    EXPECT_GT(r.median, 0);
    EXPECT_GE(r.within, 38);  // 95 % of 40
  }
  results.back().refused = "why";
  std::string const csv = promise_csv(results);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','), 3 * 14);
}

}  // namespace
}  // namespace scree
