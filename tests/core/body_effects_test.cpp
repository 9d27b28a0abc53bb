// body_effects_test.cpp: drag, global damping and applied forces: closed forms on, the plain scene's bits off.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = 3.141592653589793, g = 9.81;
double const mass = 2650 * pi / 6 * 1e-3;  // of a sphere of 0.1 m

Case one_sphere(double end, double step) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0, 0, 0}})};
  c.time.end = end;
  c.time.step = step;
  return c;
}

void run(Simulation& s) {
  while (s.step() == RunState::running) {
  }
}

double const terminal = std::sqrt(2 * mass * g / (1000 * 0.47 * pi / 4 * 0.01));  // in water-like fluid, C_d 0.47

Case sinking(double end, double step) {
  Case c = one_sphere(end, step);
  c.gravity = Vec3{0, 0, -g};
  c.drag = DragCase{1000, 0.47, {}};
  return c;
}

// From rest v(t) = v_t tanh(g t / v_t), v_t = sqrt(2 m g / (rho C A)).
TEST(Drag, FallFollowsTheHyperbolicTangentToSecondOrder) {
  Case c = sinking(0.2, 1e-3);
  double error[3];
  for (int k = 0; k < 3; ++k) {
    c.time.step = 4e-3 / (1 << k);
    Simulation s(c, {});
    run(s);
    error[k] = std::abs(-s.frame().velocity[0].z - terminal * std::tanh(g * s.time() / terminal));
    // Splitting error, relative: (g dt / v_t)^2 times a number below 1.
    EXPECT_LT(error[k] / terminal, std::pow(g * *c.time.step / terminal, 2));
    LedgerRow const row = s.ledger();
    EXPECT_GT(row.drag, 0);
    EXPECT_LT(std::abs(row.residual), std::pow(g * *c.time.step / terminal, 2) * row.moved);
  }
  // Halving the step quarters the error.
  EXPECT_NEAR(error[0] / error[1], 4, 0.1);
  EXPECT_NEAR(error[1] / error[2], 4, 0.1);
}

TEST(Drag, FallEndsAtTerminalSpeed) {
  Simulation s(sinking(4, 1e-3), {});
  run(s);
  // tanh(g t / v_t) is 1 to rounding; the splitting's own error is (g dt / v_t)^2 times a number below 1.
  EXPECT_LT(std::abs(-s.frame().velocity[0].z / terminal - 1), std::pow(g * 1e-3 / terminal, 2));
}

// A fluid that streams carries a grain along: v = w k w t / (1 + k w t), and does work on it.
TEST(Drag, AStreamCarriesGrainsAndPays) {
  Case c = one_sphere(1, 1e-2);
  double const w = 3, k = 0.5 * 1000 * 0.47 * pi / 4 * 0.01 / mass;
  c.drag = DragCase{1000, 0.47, {w, 0, 0}};
  Simulation s(c, {});
  run(s);
  double const v = w * k * w * s.time() / (1 + k * w * s.time());
  EXPECT_NEAR(s.frame().velocity[0].x, v, 1e-12 * w);  // exact: nothing else acts
  EXPECT_NEAR(s.ledger().drag, -0.5 * mass * v * v, 1e-12 * mass * w * w);
}

TEST(Damping, VelocityAndSpinDecayExactly) {
  Case c = one_sphere(1, 1e-2);
  c.grains[0].insert.velocity = {1, 2, 3};
  c.grains[0].insert.spin = {4, 0, 0};
  c.damping = DampingCase{2.5};
  Simulation s(c, {});
  run(s);
  double const keep = std::exp(-2.5 * s.time());
  EXPECT_NEAR(s.frame().velocity[0].z, 3 * keep, 1e-12);
  EXPECT_NEAR(s.frame().spin[0].x, 4 * keep, 1e-12);
  double const before = 0.5 * mass * (14 + 0.4 * 0.05 * 0.05 * 16);
  EXPECT_NEAR(s.ledger().global_damping, before * (1 - keep * keep), 1e-12 * before);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-12 * before);
}

// Terminal speed g / rate, to second order in the step: g dt / (2 sinh(rate dt / 2)).
TEST(Damping, FallsAtGravityOverRate) {
  Case c = one_sphere(4, 1e-2);
  c.gravity = Vec3{0, 0, -g};
  c.damping = DampingCase{10};
  Simulation s(c, {});
  run(s);
  EXPECT_NEAR(-s.frame().velocity[0].z, g * 1e-2 / (2 * std::sinh(0.05)), 1e-9);
  EXPECT_NEAR(-s.frame().velocity[0].z, g / 10, 0.1 * 0.1 / 24 * g / 10 * 1.1);
}

TEST(Force, ConstantForceAndTorqueAccelerateAndTheirWorkIsCounted) {
  Case c = one_sphere(0.5, 1e-3);
  c.force = {{"push", "grain", {2, 0, 0}, {0, 0, 1e-3}, 0, {}, {}}};
  Simulation s(c, {});
  run(s);
  double const v = 2 / mass * s.time(), inertia = 0.4 * mass * 0.05 * 0.05, spin = 1e-3 / inertia * s.time();
  EXPECT_NEAR(s.frame().velocity[0].x, v, 1e-12 * v);
  EXPECT_NEAR(s.frame().spin[0].z, spin, 1e-9 * spin);  // a sphere's inertia comes from an integral
  double const energy = 0.5 * mass * v * v + 0.5 * inertia * spin * spin;
  EXPECT_NEAR(s.ledger().applied, energy, 1e-9 * energy);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-12 * energy);
}

// The impulse of a window or table is the integral, whatever the step.
TEST(Force, WindowsAndTablesGiveTheirWholeImpulse) {
  Case c = one_sphere(1, 7e-3);
  c.force = {{"window", "grain", {1, 0, 0}, {}, 0.1234, 0.4321, {}},
             {"ramp", "grain", {0, 1, 0}, {}, 0, {}, {{0.1, 0.3, 0.3, 0.7}, {0, 2, -1, 0}}}};
  GrainsCase other = grains_at("sphere", {{5, 0, 0}});
  other.name = "other";
  c.grains.push_back(other);
  Simulation s(c, {});
  run(s);
  EXPECT_NEAR(s.frame().velocity[0].x, (0.4321 - 0.1234) / mass, 1e-12);
  EXPECT_NEAR(s.frame().velocity[0].y, (0.2 * 1 - 0.4 * 0.5) / mass, 1e-12);
  EXPECT_EQ(s.frame().velocity[1], (Vec3{}));  // not in the group
}

TEST(Force, LedgerClosesToSecondOrderOnATable) {
  double residual[2];
  for (int k = 0; k < 2; ++k) {
    Case c = one_sphere(0.8, 4e-3 / (1 << k));
    c.gravity = Vec3{0, 0, -g};
    c.force = {{"ramp", "grain", {0, 3, 20}, {}, 0, {}, {{0.1, 0.3, 0.6}, {0, 2, -1}}}};
    Simulation s(c, {});
    run(s);
    residual[k] = std::abs(s.ledger().residual) / s.ledger().moved;
    EXPECT_LT(residual[k], 1e-4);
  }
  EXPECT_LT(residual[1], residual[0] / 3);
}

TEST(TimeTable, MeansAreIntegrals) {
  TimeTable const t{{1, 3, 3, 4}, {0, 4, 10, 20}};
  EXPECT_EQ(mean_over(t, -2, 0.5), 0);
  EXPECT_EQ(mean_over(t, 7, 9), 20);
  EXPECT_DOUBLE_EQ(mean_over(t, 1, 3), 2);
  EXPECT_DOUBLE_EQ(mean_over(t, 2, 3.5), (0.5 * (2 + 4) + 0.5 * 12.5) / 1.5);
  EXPECT_DOUBLE_EQ(mean_over(t, 0, 5), (0 + 4 + 15 + 20) / 5.0);
  EXPECT_DOUBLE_EQ(mean_over(t, 2, 2), 2);
  EXPECT_DOUBLE_EQ(mean_over(t, 3, 3), 10);
  TimeTable const constant{{2}, {7}};
  EXPECT_EQ(mean_over(constant, 0, 9), 7);
  EXPECT_EQ(mean_over(constant, 2, 2), 7);
}

std::vector<std::string> with_stages(std::vector<std::string> const& more) {
  std::vector<std::string> stages{"bounds", "broad_phase", "sphere_contacts", "gravity"};
  for (std::string const& s : more)
    if (s == "force") stages.push_back(s);
  stages.push_back("integrate");
  for (std::string const& s : more)
    if (s != "force") stages.push_back(s);
  stages.push_back("watch");
  return stages;
}

Case bouncing() {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -g};
  c.contact[0].friction = 0.4;
  GrainsCase grains = grains_at("sphere", {{0, 0, 0.06}, {0.11, 0, 0.06}});
  grains.insert.velocity = {0.5, 0, -1};
  c.grains = {grains};
  c.wall = {floor_at(0)};
  c.time.end = 0.05;
  return c;
}

TEST(EffectPlan, EachEffectIsOneStageOneColumnAndItsArrays) {
  Case c = bouncing();
  EXPECT_EQ(Simulation(c, {}).plan().stages, with_stages({}));
  EXPECT_TRUE(Simulation(c, {}).results_header().ledger.empty());
  c.drag = DragCase{1.2, 0.5, {}};
  EXPECT_EQ(Simulation(c, {}).plan().stages, with_stages({"drag"}));
  EXPECT_EQ(Simulation(c, {}).results_header().ledger, (std::vector<std::string>{"drag"}));
  c.damping = DampingCase{1};
  c.force = {{"push", "grain", {1, 0, 0}, {}, 0, {}, {}}};
  EXPECT_EQ(Simulation(c, {}).plan().stages, with_stages({"force", "drag", "damping"}));
  EXPECT_EQ(Simulation(c, {}).plan().effects,
            (std::vector<std::string>{"gravity", "force", "drag", "global damping", "friction"}));
}

}  // namespace
}  // namespace scree
