// cohesion_test.cpp: adhesive traction outside the surface: pull-off, hanging grains, energy, conservative culling; on
// and off. Closed-form and node-covered spheres by the same formulas.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/support/contact_sets.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = 3.141592653589793, g = 9.81, d = 0.1, r = d / 2;
double constexpr weight = 2650 * pi / 6 * d * d * d * g;
double constexpr kappa = 2e6 / (pi * (d / 4) * 0.01 * d);
double constexpr range = 0.01 * d;

Case sticky(double traction) {
  Case c = rock_case();
  c.contact[0].cohesion = CohesionCase{traction, range};
  return c;
}

void run(Simulation& s) {
  while (s.step() == RunState::running) {
  }
}

// psi is largest in depth where p = 0, at traction / kappa: F = 2 pi R (traction range + traction^2 / (2 kappa)).
TEST(Cohesion, PullOffForceIsTheFormula) {
  double const traction = 1e5, pull_off = 2 * pi * r * (traction * range + traction * traction / (2 * kappa));
  Case c = sticky(traction);
  GrainsCase spheres = grains_at("sphere", {});
  for (int i = -150; i <= 50; ++i) spheres.insert.position.push_back({0.3 * i, 0, r - traction / kappa * i});
  spheres.count = static_cast<int>(spheres.insert.position.size());
  c.grains = {spheres};
  c.wall = {floor_at(0)};
  Simulation s(c, {});
  double strongest = 0;
  for (PairResult const& pair : s.impl().work.result) strongest = std::min(strongest, pair.elastic.force_on_a.z);
  EXPECT_NEAR(-strongest / pull_off, 1, 1e-12);

  // Nodes: 120 orientations with some 40 nodes within the range each.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> u(-1, 1);
  GrainsCase balls = grains_at("ellipsoid:1:1:1", {}, d, 4000);
  for (int i = 0; i < 120; ++i) {
    balls.insert.position.push_back({0.3 * i, 0, r - traction / kappa});
    balls.insert.quaternion.push_back(normalized(Quat{u(random), u(random), u(random), u(random)}));
  }
  balls.count = 120;
  c.grains = {balls};
  Simulation nodes(c, {});
  double mean = 0;
  for (PairResult const& pair : nodes.impl().work.result) mean += pair.elastic.force_on_a.z / 120;
  EXPECT_NEAR(-mean / pull_off, 1, 0.01);
}

TEST(Cohesion, AGrainHangsWhileTheFormulaCarriesItsWeight) {
  for (char const* shape : {"sphere", "ellipsoid:1:1:1"})
    for (double share : {1.3, 0.7}) {
      Case c = sticky(share * weight / (2 * pi * r * range));
      c.gravity = Vec3{0, 0, -g};
      c.contact[0].damping_ratio = 0.5;
      WallCase ceiling = floor_at(0);
      ceiling.normal = {0, 0, -1};
      c.wall = {ceiling};
      c.grains = {grains_at(shape, {{0, 0, -r}}, d, 4000)};
      c.time.end = 0.2;
      Simulation s(c, {});
      run(s);
      if (share > 1) {
        EXPECT_GT(s.frame().position[0].z, -r - range) << shape;
      } else {
        EXPECT_LT(s.frame().position[0].z, -r - 0.5 * 0.25 * g * 0.2 * 0.2) << shape;
      }
      EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved) << shape << ", share " << share;
    }
}

// Grains that meet and part, undamped: what the adhesion gave on the way in it takes on the way out.
TEST(Cohesion, CollisionsKeepTheEnergy) {
  for (ContactLaw law : {ContactLaw::winkler, ContactLaw::linear, ContactLaw::hertz})
    for (char const* shape : {"sphere", "ellipsoid:1:0.8:0.6"})
      for (double offset : {0.0, 0.03}) {
        Case c = sticky(1e5);
        c.contact[0].law = law;
        c.contact[0].youngs_modulus = 1e9;
        GrainsCase a = grains_at(shape, {{-0.06, offset, 0}}), b = grains_at(shape, {{0.06, 0, 0.01}});
        b.name = "other";
        a.insert.velocity = {1, 0, 0};
        b.insert.velocity = {-1, 0, 0};
        c.grains = {a, b};
        c.time.end = 0.05;
        Simulation s(c, {});
        double lowest = 0;
        while (s.step() == RunState::running) lowest = std::min(lowest, s.ledger().elastic_normal);
        EXPECT_LT(lowest, -1e-4) << "nothing was stored outside";
        EXPECT_EQ(s.ledger().elastic_normal, 0) << "still within the range";
        EXPECT_LT(std::abs(s.ledger().residual), 2e-4 * s.ledger().moved)
            << shape << ", law " << static_cast<int>(law) << ", offset " << offset;
      }
}

Case heap() {
  Case c = sticky(2e4);
  c.gravity = Vec3{0, 0, -g};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.7;
  GrainsCase grains = grains_at("sphere", {}, d, 250);
  grains.count = 8;
  grains.insert.kind = InsertCase::Kind::lattice;
  grains.insert.orientation = Orientation::random;
  grains.insert.velocity = {0.8, 0.4, -4};
  grains.insert.box = {{0, 0, 0}, {0.34, 0.34, 1.2}};
  c.grains = {grains};
  c.wall = {open_box({0, 0, 0}, {0.34, 0.34, 2})};
  c.time.end = 0.03;
  return c;
}

// Nodes within the range are all found: for formulas, and for networks, whose phi outside is not a distance.
TEST(Cohesion, NodeListsGiveTheContactSetsOfBruteForce) {
  Case c = heap();
  c.grains[0].shapes = {"ellipsoid:1:0.8:0.6", "box:1:1:0.7", "sphere"};
  Simulation lists(c, {}), brute(c, {.threads = 2, .brute_force = true});
  expect_same_contact_sets(lists, brute, 500);
  c.library = {{"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  c.grains[0].shapes = {"grains:ballast/0", "grains:sand/4", "grains:cobble/1", "grains:ellipsoid/3"};
  c.grains[0].nodes = 64;
  c.time.end = 0.02;
  Simulation nets(c, {.threads = 2}), all(c, {.threads = 2, .brute_force = true});
  expect_same_contact_sets(nets, all, 100);
  EXPECT_LT(std::abs(nets.ledger().residual), 1e-3 * nets.ledger().moved);
}

// Absent or of zero strength: the same plan and bits.
TEST(Cohesion, OffIsAbsent) {
  Case off = heap(), zero = off, narrow = off, on = off;
  for (Case* c : {&off, &zero, &narrow, &on}) c->grains[0].shapes = {"ellipsoid:1:0.8:0.6", "sphere"};
  off.contact[0].cohesion.reset();
  zero.contact[0].cohesion = CohesionCase{0, range};
  narrow.contact[0].cohesion = CohesionCase{1e5, 0};
  Simulation s(off, {}), z(zero, {}), n(narrow, {}), o(on, {});
  for (Simulation* each : {&s, &z, &n, &o}) run(*each);
  for (Simulation* none : {&z, &n}) {
    EXPECT_EQ(s.frame().position, none->frame().position);
    EXPECT_EQ(s.frame().orientation, none->frame().orientation);
    EXPECT_EQ(s.plan().stages, none->plan().stages);
    EXPECT_EQ(s.plan().effects, none->plan().effects);
    EXPECT_EQ(s.plan().law, none->plan().law);
    EXPECT_EQ(launches(s), launches(*none));
  }
  EXPECT_NE(s.frame().position, o.frame().position);
  std::vector<std::string> const effects = o.plan().effects;
  EXPECT_EQ(std::count(effects.begin(), effects.end(), "cohesion"), 1);
  EXPECT_NE(o.plan().law.find("cohesion 2e+04 Pa within 0.001 m"), std::string::npos) << o.plan().law;
  ASSERT_EQ(o.plan().arrays.size(), s.plan().arrays.size());
}

}  // namespace
}  // namespace scree
