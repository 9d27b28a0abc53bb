// cost_test.cpp: the meters of `scree cost` where their answers are known: errors, queries, forces, the front.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/cost_table.h"

namespace scree {
namespace {

CostOptions small() {
  CostOptions o;
  o.grains = 4;
  return o;
}

Simulation simulation_of(std::string const& shape, int nodes, SimulationOptions const& options = {}) {
  return Simulation(cost_case(small(), {"test", shape, Evaluator::analytic, 0, {}}, nodes), options);
}

TEST(Cost, OffersThatAnotherBeatsAreNotOnTheFront) {
  // Price, error. Dearer and worse; equal price and worse; equal to an earlier one; as good and dearer.
  std::vector<std::pair<double, double>> const offers = {{1, 0.5}, {2, 0.2}, {3, 0.3}, {2, 0.25},
                                                         {4, 0},   {1, 0.5}, {5, 0},   {0.5, 0.9}};
  EXPECT_EQ(pareto_front(offers), (std::vector<char>{1, 1, 0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(pareto_front({}), std::vector<char>{});
}

TEST(Cost, AFormulasOwnErrorIsZeroAndThatOfASphereIsItsDistance) {
  QueryPoints const band = truth_points(300, 0.05), surface = truth_points(300, 0);
  for (double phi : surface.phi) EXPECT_NEAR(phi, 0, 1e-12);
  for (double phi : band.phi) EXPECT_LE(std::abs(phi), 0.05 + 1e-12);
  EXPECT_GT(*std::max_element(band.phi.begin(), band.phi.end()), 0.04);
  EXPECT_LT(*std::min_element(band.phi.begin(), band.phi.end()), -0.04);
  QueryRow own, sphere;
  Simulation truth = simulation_of(cost_truth, 100);
  measure_queries(truth, band, surface, own);
  EXPECT_EQ(own.phi_largest, 0);
  EXPECT_EQ(own.normal_p95, 0);
  Simulation ball = simulation_of("sphere", 100);
  measure_queries(ball, band, surface, sphere);
  double mean = 0, largest = 0, turned = 0;
  for (std::size_t i = 0; i < band.phi.size(); ++i) {
    double const error = std::abs(0.5 - norm(band.point[i]) - band.phi[i]);
    mean += error / static_cast<double>(band.phi.size()), largest = std::max(largest, error);
  }
  for (std::size_t i = 0; i < surface.phi.size(); ++i) {
    double const cosine = -dot(normalized(surface.point[i]), normalized(surface.gradient[i]));
    turned += std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi / static_cast<double>(surface.phi.size());
  }
  EXPECT_NEAR(sphere.phi_mean, mean, 1e-12);
  EXPECT_NEAR(sphere.phi_largest, largest, 1e-12);
  EXPECT_NEAR(sphere.normal_mean, turned, 1e-6);  // acos of nearly 1
  EXPECT_EQ(sphere.phi_seconds.size(), 1u);
}

// Brute force asks every block and every node of every side at every step: of both grains of a pair, and of a grain
// within 0.25 d of a wall's box. Every node that carries force is asked once more.
TEST(Cost, BruteForceAsksEveryNodeAndFourTimesTheNodesAreFourTimesTheQueries) {
  int constexpr steps = 3;
  std::vector<PairPose> const pairs = draw_pairs(2, 0.01);
  double queries[2];
  for (int k : {0, 1}) {
    Simulation s = simulation_of(cost_truth, k == 0 ? 250 : 1000, {.threads = 1, .brute_force = true});
    set_up_pairs(s, pairs, 0, 0);
    StepMeter meter(s);
    State const state = s.impl().state;
    Workspace const work = s.impl().work;
    SteppedScene scene = meter.warm("pairs", state, work, 1);
    meter.measure(scene, steps);
    meter.measure(scene, steps);
    int const nodes = s.impl().scene.shape[0].nodes;
    EXPECT_EQ(nodes_of_contacting_pairs(s.impl().scene, scene.work), 2 * 2 * nodes);
    int const sides = static_cast<int>(scene.work.gather.lists.side.size());
    EXPECT_GE(sides, 2 * 2);
    EXPECT_EQ(scene.counts.listed, steps * sides * nodes);
    EXPECT_EQ(scene.counts.block, steps * sides * s.impl().scene.shape[0].blocks);
    EXPECT_GT(scene.counts.active, 0);
    EXPECT_EQ(scene.counts.again, scene.counts.active);
    EXPECT_EQ(scene.wall.size(), 2u);
    queries[k] = static_cast<double>(scene.counts.queries());
  }
  // A few nodes less than asked for, blocks that are not full, and those that carry force.
  EXPECT_NEAR(queries[1] / queries[0], 4, 0.08);
}

TEST(Cost, PairsAreAsDeepAsAskedFor) {
  std::vector<PairPose> const pairs = draw_pairs(2, 0.01);
  Simulation s = simulation_of(cost_truth, 4000);
  EXPECT_EQ(measure_forces(s, pairs).rounding, 0);
  // Between 500 points, 0.08 d apart, the surface is up to 0.04^2 (1/R1 + 1/R2) / 2 deeper with radii of 0.4 d; the
  // nodes, 0.028 d apart, miss less than a fifth of that.
  EXPECT_GT(s.largest_overlap(), 0.0095);
  EXPECT_LT(s.largest_overlap(), 0.01 + 0.5 * 0.04 * 0.04 * 5);
}

// F = pi R kappa x^2 with R = d/4 between equal balls; 4,000 nodes are 0.028 d apart on a contact of 0.14 d across.
TEST(Cost, BallsThatAreCoveredWithNodesCarryTheForceOfSpheres) {
  Simulation s = simulation_of("ellipsoid:1:1:1", 4000);
  std::vector<PairPose> pairs = draw_pairs(2, 0.01);
  for (PairPose& p : pairs) p.distance = 0.99;
  std::vector<Vec3> const force = measure_forces(s, pairs).force;
  double const kappa = s.impl().scene.contact[0].normal.modulus, d = 0.1;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Vec3 const exact = pairs[k].direction * (-std::numbers::pi * d / 4 * kappa * 1e-4 * d * d);  // pushes a back
    EXPECT_LT(norm(force[k] - exact), 0.05 * norm(exact));
  }
  std::vector<Vec3> const larger = {force[0] * 1.03, force[1] * 0.96};
  EXPECT_NEAR(force_error(larger, force), std::sqrt((9 + 16) / 2.0) / 100, 1e-12);
}

TEST(Cost, SmallerStepsKeepMoreOfTheEnergyAndComeCloserToTheWay) {
  Simulation s = simulation_of(cost_truth, 250);
  std::vector<CollisionRow> const rows = measure_collisions(s, draw_pairs(2, 0.01), {1000, 4, 1, 0.25}, 1);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_TRUE(rows[0].end.empty());  // beyond the critical step
  // Second order: a quarter of the step is a sixteenth of the error, give or take what single nodes do.
  EXPECT_LT(rows[2].energy, 0.5 * rows[1].energy);
  EXPECT_LT(rows[2].energy, 1e-3);
  EXPECT_LT(rows[2].trajectory, 0.5 * rows[1].trajectory);
  EXPECT_EQ(rows[3].trajectory, 0);
  EXPECT_NEAR(rows[3].seconds * rows[3].steps, rows[1].seconds * rows[1].steps, 1e-12);
  // They met: with a speed of 0.5 m/s each they would be 5 mm on their way.
  EXPECT_GT(norm(rows[3].end[0] - rows[3].end[1]), 0.09);
}

TEST(Cost, TablesNameEveryColumnAndMarkTheFront) {
  CostRow cheap, dear, beaten;
  cheap.subject = "grid 22", cheap.nodes = 250, cheap.error = 0.5, cheap.rest_us = 1;
  cheap.step = dear.step = beaten.step = 1e-5;
  dear.subject = "net 6x64", dear.nodes = 1000, dear.error = 0.1, dear.rest_us = 2;
  beaten.subject = "net 6x64", beaten.nodes = 250, beaten.error = 0.6, beaten.rest_us = 1.5;
  QueryRow grid, net;
  grid.subject = "grid 22", net.subject = "net 6x64";
  std::string const list = price_list({cheap, dear, beaten}, {grid, net});
  EXPECT_NE(list.find("| 50 % | 0 % | 0 % | grid 22 * | 250 |"), std::string::npos) << list;
  EXPECT_NE(list.find("| net 6x64 * | 1000 |"), std::string::npos) << list;
  EXPECT_NE(list.find("| net 6x64 | 250 |"), std::string::npos) << list;
  EXPECT_NE(effect_csv({{"none", 2, 4}, {"friction", 3, 5}}).find("friction,3,5,1.500,1.250\n"), std::string::npos);
  CollisionRow stopped;
  for (std::string const& text : {cost_csv({cheap, dear}), query_csv({grid, net}), collision_csv({stopped, stopped}),
                                  effect_csv({{"none", 2, 4}, {"friction", 3, 5}})}) {
    std::size_t const line = text.find('\n');
    auto const commas = [](std::string const& s) { return std::count(s.begin(), s.end(), ','); };
    EXPECT_EQ(commas(text), 3 * commas(text.substr(0, line))) << text;
  }
}

}  // namespace
}  // namespace scree
