// contact_law_test.cpp: the three contact laws through nodes and in closed form: force, energy, restitution, friction.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/simulation_impl.h"
#include "kernels/restitution.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = 3.141592653589793;
double constexpr d = 0.1, ball_mass = 2650 * pi / 6 * d * d * d;

// Of the laws' parameters: alike in stiffness at about 1 % d.
double constexpr k_n = 2e6, youngs = 1e9, poisson = 0.25;

std::string name_of(::testing::TestParamInfo<ContactLaw> const& info) {
  char const* const names[] = {"winkler", "linear", "hertz"};
  return names[static_cast<int>(info.param)];
}

class Law : public ::testing::TestWithParam<ContactLaw> {
 protected:
  Case law_case() const {
    Case c = rock_case();
    c.contact[0].law = GetParam();
    c.contact[0].youngs_modulus = youngs;
    c.contact[0].poisson_ratio = poisson;
    return c;
  }
  // Force of a ball of radius d/2 on a plane, by the formulas of design physics.md section 1, linear with its onset's
  // share.
  double ball_on_plane(double x) const {
    double const r = d / 2;
    switch (GetParam()) {
      case ContactLaw::winkler:
        return pi * r * (k_n / (pi * d / 4 * 0.01 * d)) * x * x;
      case ContactLaw::linear:
        return k_n * r / (d / 4) * (x - 0.5e-3 * d);
      default:
        return 4.0 / 3 * youngs / (2 * (1 - poisson * poisson)) * std::sqrt(r) * std::pow(x, 1.5);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(All, Law, ::testing::Values(ContactLaw::winkler, ContactLaw::linear, ContactLaw::hertz),
                         name_of);

TEST_P(Law, SphereOnAPlaneCarriesTheClosedForm) {
  for (double x : {0.002 * d, 0.01 * d, 0.03 * d}) {
    Case c = law_case();
    c.grains = {grains_at("sphere", {{0, 0, d / 2 - x}})};
    c.wall = {floor_at(0)};
    Simulation s(c, {});
    EXPECT_NEAR(s.impl().work.result.at(0).elastic.force_on_a.z / ball_on_plane(x), 1, 1e-12);
  }
}

// 4,000 nodes, 120 orientations: 40 to 120 of them inside, evenly spread: 1 % for the mean.
TEST_P(Law, NodeCoveredSphereOnAPlaneCarriesTheClosedForm) {
  for (double x : {0.01 * d, 0.03 * d}) {
    Case c = law_case();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(-1, 1);
    GrainsCase g = grains_at("ellipsoid:1:1:1", {}, d, 4000);
    for (int i = 0; i < 120; ++i) {
      g.insert.position.push_back({0.3 * i, 0, d / 2 - x});
      g.insert.quaternion.push_back(normalized(Quat{u(random), u(random), u(random), u(random)}));
    }
    g.count = 120;
    c.grains = {g};
    c.wall = {floor_at(0)};
    Simulation s(c, {});
    double mean = 0;
    for (PairResult const& r : s.impl().work.result) mean += r.elastic.force_on_a.z / 120;
    EXPECT_NEAR(mean / ball_on_plane(x), 1, 0.01) << "overlap " << x / d << " d";
  }
}

Case collision(Case c, char const* shape, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  GrainsCase a = grains_at(shape, {{-0.06, 0.01 * u(random), 0.01 * u(random)}}), b = grains_at(shape, {{0.06, 0, 0}});
  for (GrainsCase* g : {&a, &b}) g->insert.quaternion = {normalized(Quat{u(random), u(random), u(random), u(random)})};
  b.name = "other";
  a.insert.velocity = {1, 0, 0};
  b.insert.velocity = {-1, 0.1, 0};
  c.grains = {a, b};
  c.time.end = 0.05;
  return c;
}

// Without damping and friction nothing is lost: the bound is that of the automatic step (core/time_step.cpp).
TEST_P(Law, FrictionlessCollisionsKeepTheEnergy) {
  for (char const* shape : {"ellipsoid:1:0.8:0.6", "sphere"})
    for (unsigned seed = 0; seed < 3; ++seed) {
      Simulation s(collision(law_case(), shape, seed), {});
      double deepest = 0;
      while (s.step() == RunState::running) deepest = std::max(deepest, s.largest_overlap());
      EXPECT_GT(deepest, 1e-3);
      EXPECT_EQ(s.largest_overlap(), 0) << "still in contact: prolong the run";
      LedgerRow const ledger = s.ledger();
      EXPECT_LT(std::abs(ledger.residual), 2e-4 * ledger.moved) << shape << ", pose " << seed;
      EXPECT_EQ(ledger.damping, 0);
      EXPECT_EQ(ledger.friction, 0);
    }
}

double rebound(Case c, char const* shape, double speed) {
  GrainsCase g = grains_at(shape, {{0, 0, d / 2 + 1e-4}});
  g.insert.velocity = {0, 0, -speed};
  c.grains = {g};
  c.wall = {floor_at(0)};
  c.time.end = 1;
  c.time.safety = 0.1;
  Simulation s(c, {});
  bool touched = false;
  while (s.step() == RunState::running) {
    touched = touched || s.largest_overlap() > 0;
    if (touched && s.largest_overlap() == 0) break;
  }
  return s.frame().velocity[0].z / speed;
}

TEST_P(Law, RestitutionIsWhatTheCaseAsksOnBothPaths) {
  for (double e : {0.25, 0.5, 0.8})
    for (double speed : {1.0, 3.0})
      for (char const* shape : {"ellipsoid:1:1:1", "sphere"}) {
        Case c = law_case();
        c.contact[0].restitution = e;
        EXPECT_NEAR(rebound(c, shape, speed), e, 0.02) << shape << ", e " << e << " at " << speed << " m/s";
      }
}

TEST_P(Law, ARatioReboundsAlikeOnBothPaths) {
  for (double zeta : {0.1, 0.7}) {
    Case c = law_case();
    c.contact[0].damping_ratio = zeta;
    double const e = restitution_of(zeta, DampingPath::nodes, GetParam());
    for (char const* shape : {"ellipsoid:1:1:1", "sphere"}) EXPECT_NEAR(rebound(c, shape, 2), e, 0.02) << shape;
  }
}

// Speed of separation over that of approach of a cube that falls flat on a plane, or on the face of a larger block.
double flat_rebound(Case c, bool on_block, double speed) {
  double const half = 0.5 * std::cbrt(pi / 6);  // of a cube [d]
  GrainsCase cube = grains_at("box:1:1:1", {{0, 0, half * d + 1e-5}}), block = grains_at("box:1:1:1", {}, 2 * d);
  block.name = "block";
  block.count = 1;
  block.insert.position = {{0, 0, -half * 2 * d}};
  cube.insert.velocity = {0, 0, -speed};
  c.grains = {cube};
  if (on_block)
    c.grains.push_back(block);
  else
    c.wall = {floor_at(0)};
  c.time.end = 0.1;
  c.time.safety = 0.1;
  Simulation s(c, {});
  bool touched = false;
  while (s.step() == RunState::running) {
    touched = touched || s.largest_overlap() > 0;
    if (touched && s.largest_overlap() == 0) break;
  }
  Frame const f = s.frame();
  return (f.velocity[0].z - (on_block ? f.velocity[1].z : 0)) / speed;
}

// The same as one equation, in units where the mass, the speed and the force c A beyond the onset are 1: F = p(x), with
// the damping 2 zeta sqrt(K) v, K = F p(2 x) / psi(2 x), that the linear law's contacts have; pushing only.
double flat_rebound_by_formula(double zeta, double onset) {
  PressureLaw const law{ContactLaw::linear, 1, onset, 0};
  auto const acceleration = [&](double x, double v) {
    if (!(x > 0)) return 0.0;
    double const force = law.pressure(x), stiffness = force * law.pressure(2 * x) / law.energy(2 * x);
    return -std::max(0.0, force + 2 * zeta * std::sqrt(stiffness) * v);
  };
  double x = 1e-9, v = 1, dt = 1e-4;
  while (x > 0 || v > 0) {
    double const k1 = acceleration(x, v), k2 = acceleration(x + dt / 2 * v, v + dt / 2 * k1);
    double const k3 = acceleration(x + dt / 2 * (v + dt / 2 * k1), v + dt / 2 * k2);
    double const k4 = acceleration(x + dt * (v + dt / 2 * k2), v + dt * k3);
    x += dt * (v + dt * (k1 + k2 + k3) / 6);
    v += dt * (k1 + 2 * k2 + 2 * k3 + k4) / 6;
  }
  return -v;
}

// Flat faces carry c A x/onset up to the onset and c A from there on. With K = F/x and F/(2x) both are, in the variable
// x or sqrt(x), the damped oscillator of the smooth contact (Tsuji, Tanaka, Ishida, Powder Technol. 71 (1992) 239), so
// that e is the same below the onset (stiff: x = 0.2 onsets) and far beyond it (soft: 8 and 34); in between the rise of
// p leaves it up to 0.04 high. Nodes against the equation: 0.01; a step is about 2 % of the time in contact.
TEST(LinearLaw, FlatFacesReboundAsTheRatioSays) {
  for (double zeta : {0.1, 0.4, 0.7})
    for (auto const& [stiffness, speed] : {std::pair{2e6, 0.5}, {2e4, 1.0}, {2e4, 2.0}})
      for (bool on_block : {false, true}) {
        Case c = rock_case();
        c.contact[0].law = ContactLaw::linear;
        c.contact[0].stiffness = stiffness;
        c.contact[0].damping_ratio = zeta;
        double const largest = on_block ? 2 * d : d, face = std::pow(pi / 6, 2.0 / 3) * d * d;
        double const mass = on_block ? ball_mass * 8 / 9 : ball_mass;  // the block has 8 times the cube's
        double const onset = 1e-3 * largest * linear_modulus(stiffness, largest) * face / (mass * speed * speed);
        double const e = flat_rebound(c, on_block, speed);
        SCOPED_TRACE(std::to_string(zeta) + ", " + std::to_string(stiffness) + " N/m at " + std::to_string(speed) +
                     " m/s" + (on_block ? " on a block" : " on a plane"));
        EXPECT_NEAR(e, flat_rebound_by_formula(zeta, onset), 0.01);
        EXPECT_NEAR(e, restitution_of(zeta, DampingPath::nodes, ContactLaw::linear), 0.04);
      }
}

// A grain that bounces, slides and comes to rest under friction: the ledger closes, so no law's tangential springs make
// energy, and friction loses some.
TEST_P(Law, FrictionClosesTheLedgerOnBothPaths) {
  for (char const* shape : {"ellipsoid:1:0.8:0.6", "sphere"}) {
    Case c = law_case();
    c.gravity = Vec3{0, 0, -9.81};
    c.contact[0].friction = 0.4;
    c.contact[0].restitution = 0.4;
    GrainsCase g = grains_at(shape, {{0, 0, 0.07}});
    g.insert.velocity = {1, 0.3, -1};
    c.grains = {g};
    c.wall = {floor_at(0)};
    c.time.end = 0.3;
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    EXPECT_GT(s.ledger().friction, 0.01 * s.ledger().moved);
    EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved) << shape;
    EXPECT_TRUE(s.messages().empty());
  }
}

TEST(ContactLaws, ThePlanNamesTheLawOfEachPair) {
  Case c = rock_case();
  c.material.push_back({"steel", 7800});
  ContactCase other = c.contact[0];
  other.pair = {"rock", "steel"};
  other.law = ContactLaw::hertz;
  other.youngs_modulus = youngs;
  c.contact.push_back(other);
  c.contact[0].law = ContactLaw::linear;
  WallCase steel = floor_at(0);
  steel.material = "steel";
  c.wall = {steel};
  c.grains = {grains_at("sphere", {{0, 0, 1}})};
  std::string const law = Simulation(c, {}).plan().law;
  EXPECT_NE(law.find("rock - rock: linear pressure"), std::string::npos) << law;
  EXPECT_NE(law.find("rock - steel: hertz E*"), std::string::npos) << law;
}

}  // namespace
}  // namespace scree
