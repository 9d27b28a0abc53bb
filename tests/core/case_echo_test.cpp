// case_echo_test.cpp: a case that is written out reads back as the same case.
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "core/case.h"
#include "tests/core/case_file_fixture.h"

namespace scree {
namespace {

using namespace testing;

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
  if (a.rolling) {
    EXPECT_EQ(std::tie(a.rolling->friction, a.rolling->stiffness_ratio, a.rolling->damping),
              std::tie(b.rolling->friction, b.rolling->stiffness_ratio, b.rolling->damping));
  }
  ASSERT_EQ(a.cohesion.has_value(), b.cohesion.has_value());
  if (a.cohesion) {
    EXPECT_EQ(std::tie(a.cohesion->traction, a.cohesion->range), std::tie(b.cohesion->traction, b.cohesion->range));
  }
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
  ASSERT_TRUE(problems(a).empty()) << ::testing::PrintToString(problems(a));
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

}  // namespace
}  // namespace scree
