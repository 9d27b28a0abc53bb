// measure_forces_test.cpp: meters against answers known by formula: stress, force chains, contacts, motion, blockage.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/measures.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = std::numbers::pi, g = 9.81, kappa = 1e9;
double const sphere_mass = 2650 * pi / 6 * 1e-3;  // d = 0.1 m

// Of two spheres of 0.1 m, and of one on a plane: pi R kappa x^2.
double between_spheres(double overlap) { return pi * 0.025 * kappa * overlap * overlap; }
double on_plane(double overlap) { return pi * 0.05 * kappa * overlap * overlap; }

Case spheres(std::vector<Vec3> const& position) {
  Case c = rock_case();
  c.contact[0].kappa = kappa;
  c.grains = {grains_at("sphere", position)};
  return c;
}

MeasureCase in_box(char const* name, char const* kind, Vec3 min, Vec3 max) {
  MeasureCase m = measure(name, kind);
  m.box = Box{min, max};
  return m;
}

TEST(Stress, OfTwoSpheresByHand) {
  double const overlap = 1e-3, length = 0.1 - overlap, force = between_spheres(overlap);
  Vec3 const n{0.6, 0, 0.8};
  Case c = spheres({{0, 0, 0}, n * length});
  c.measure = {in_box("all", "stress", {-1, -1, -1}, {1, 1, 1}),
               in_box("half", "stress", {-1, -1, -1}, {1, 1, 0.8 * length / 2}),
               in_box("none", "stress", {-1, -1, 0.5}, {1, 1, 1})};
  Measured m = measured_at_once(c);
  double const all = force * length / 8, half = force * length / 2 / (4 * (1 + 0.4 * length));
  EXPECT_NEAR(m["all.xx"].last, all * 0.36, 1e-6 * all);
  EXPECT_NEAR(m["all.zz"].last, all * 0.64, 1e-6 * all);
  EXPECT_NEAR(m["all.xz"].last, all * 0.48, 1e-6 * all);
  EXPECT_NEAR(m["all.yy"].last, 0, 1e-9 * all);
  EXPECT_NEAR(m["all.pressure"].last, all / 3, 1e-6 * all);
  EXPECT_NEAR(m["all.deviator"].last, all, 1e-6 * all);  // uniaxial
  EXPECT_NEAR(m["half.zz"].last, half * 0.64, 1e-6 * half);
  EXPECT_EQ(m["none.pressure"].last, 0);
}

// A column at rest carries at each contact what lies above it.
TEST(Stress, OfAColumnUnderItsWeight) {
  int constexpr count = 4;
  std::vector<Vec3> position;
  for (int i = 0; i < count; ++i) position.push_back({0, 0, 0.0499 + 0.0998 * i});
  Case c = spheres(position);
  c.gravity = Vec3{0, 0, -g};
  c.damping = DampingCase{20};
  c.contact[0].damping_ratio = 0.7;
  c.wall = {floor_at(0)};
  c.time.end = 1.5;
  c.output.every = 1.5;
  c.measure = {in_box("column", "stress", {-0.1, -0.1, -0.01}, {0.1, 0.1, 0.49})};
  Simulation s(c, {});
  Measured m = run_to_end(s);
  double sum = 0, below = 0;
  std::vector<Vec3> const x = s.frame().position;
  for (int i = 0; i < count; ++i) {
    sum += (count - i) * sphere_mass * g * (i == 0 ? x[0].z : x[i].z - below);
    below = x[i].z;
  }
  double const volume = 0.2 * 0.2 * 0.5;
  EXPECT_NEAR(m["column.zz"].last, sum / volume, 1e-3 * sum / volume);
  EXPECT_LT(std::abs(m["column.xx"].last), 1e-6 * sum / volume);
}

// Overlaps of 1, 1 and 2 mm: forces of 1, 1 and 4 times the first's.
TEST(ForceChains, CountContactsAboveTheMean) {
  Case c = spheres({{0, 0, 0}, {0.099, 0, 0}, {0.198, 0, 0}, {0.296, 0, 0}, {0, 1, 0.049}});
  c.wall = {floor_at(0)};
  c.wall[0].point.z = -5;
  MeasureCase m = measure("chains", "force_chains");
  m.contacts = true;
  c.measure = {m};
  Measured out = measured_at_once(c);
  double const f = between_spheres(1e-3);
  EXPECT_EQ(out["chains.count"].last, 1);
  EXPECT_NEAR(out["chains.share"].last, 1 / 3.0, 1e-12);
  EXPECT_NEAR(out["chains.carried"].last, 4 / 6.0, 1e-9);
  EXPECT_NEAR(out["chains.mean_force"].last, 2 * f, 1e-6 * f);
  EXPECT_NEAR(out["chains.largest_force"].last, 4 * f, 1e-6 * f);
  c.measure[0].above = 0.4;
  EXPECT_EQ(measured_at_once(c)["chains.count"].last, 3);
}

// Every contact where it is: between spheres in the middle of the overlap, on walls at rest and on bodies on the wall.
TEST(ForceChains, ContactsAreWrittenWithTheirPlaceAndForce) {
  double const x = 1e-3;
  for (bool body : {false, true}) {
    Case c = spheres({{0, 0, 0.05 - x}, {0, 0, 0.15 - 2 * x}});
    WallCase other = floor_at(-3);
    other.name = "other";
    c.wall = {other, floor_at(0)};
    if (body) c.wall[1].motion = later();
    MeasureCase m = measure("chains", "force_chains");
    m.contacts = true;
    c.measure = {m};
    c.time.step = c.time.end = c.output.every = 1e-12;
    Simulation s(c, {});
    run_to_end(s);
    auto const rows = s.measure_rows();
    ASSERT_EQ(rows.size(), 1u);
    ASSERT_EQ(rows[0].contact.size(), 2u);
    for (ContactRow const& k : rows[0].contact) {
      EXPECT_EQ(k.a, 0);
      bool const wall = k.b < 0;
      EXPECT_EQ(k.b, wall ? -2 : 1);  // the second wall of the case
      EXPECT_NEAR(norm(k.point - Vec3{0, 0, wall ? 0 : 0.1 - 1.5 * x}), 0, 1e-9);
      EXPECT_NEAR(k.force.z, wall ? on_plane(x) : -between_spheres(x), 1e-6 * on_plane(x));
    }
  }
}

// Adhesion: pulled towards each other, the contact is still between them.
TEST(ForceChains, PullsActBetweenTheGrainsToo) {
  Case c = spheres({{0, 0, 0}, {0.1005, 0, 0}});
  c.contact[0].cohesion = CohesionCase{1e5, 2e-3};
  MeasureCase m = measure("chains", "force_chains");
  m.contacts = true;
  c.measure = {m};
  c.time.step = c.time.end = c.output.every = 1e-12;
  Simulation s(c, {});
  run_to_end(s);
  auto const rows = s.measure_rows();
  ASSERT_EQ(rows.at(0).contact.size(), 1u);
  EXPECT_GT(rows[0].contact[0].force.x, 0);
  EXPECT_NEAR(rows[0].contact[0].point.x, 0.1005 / 2, 1e-6);
}

Case flying() {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -1e-9};  // says where up is
  c.grains = {grains_at("sphere", {{0, 0, 0}, {0, 1, 0}, {0, 2, 0}})};
  GrainsCase other = grains_at("sphere", {{0, 5, 0}});
  other.name = "other";
  c.grains[0].insert.velocity = {3, 0, 4};
  other.insert.velocity = {-1, 2, 0};
  other.insert.spin = {0, 0, 8};
  c.grains.push_back(other);
  c.time.end = 1;
  c.time.step = 1e-3;
  c.output.every = 0.5;
  return c;
}

TEST(Velocity, MeansAndLargest) {
  Case c = flying();
  MeasureCase one = measure("one", "velocity");
  one.grains = "other";
  c.measure = {measure("all", "velocity"), one, in_box("nobody", "velocity", {50, 0, 0}, {51, 1, 1})};
  Simulation s(c, {});
  Measured m = run_to_end(s);
  EXPECT_NEAR(m["all.mean"].last, (3 * 5 + std::sqrt(5)) / 4, 1e-6);
  EXPECT_NEAR(m["all.largest"].last, 5, 1e-6);
  EXPECT_NEAR(m["all.x"].last, (3 * 3 - 1) / 4.0, 1e-6);
  EXPECT_NEAR(m["all.z"].last, 3 * 4 / 4.0, 1e-6);
  EXPECT_NEAR(m["all.spin"].last, 8 / 4.0, 1e-6);
  EXPECT_NEAR(m["one.mean"].last, std::sqrt(5), 1e-6);
  EXPECT_TRUE(std::isnan(m["nobody.mean"].last));
  EXPECT_EQ(m["nobody.mean"].samples, 0);
}

TEST(Trajectory, FollowsTheNamedGrains) {
  Case c = flying();
  MeasureCase path = measure("path", "trajectory");
  path.grains = "grain";
  path.index = {2};
  c.measure = {path};
  DeleteCase end;
  end.name = "end";
  end.plane = true;
  end.point = {2.5, 0, 0};
  end.normal = {-1, 0, 0};
  Simulation s(c, {});
  run_to_end(s);
  auto const rows = s.measure_rows();
  ASSERT_EQ(rows.size(), 2u);
  for (MeasureRow const& row : rows) {
    double const expected[] = {3 * row.time, 2, 4 * row.time, 3, 0, 4};
    for (int q = 0; q < 6; ++q) EXPECT_NEAR(row.value[q], expected[q], 1e-6) << q;
  }
  EXPECT_EQ(s.measure_quantities(0)[3].name, "2.vx");
  c.deletion = {end};  // gone at t = 0.83
  Simulation gone(c, {});
  run_to_end(gone);
  EXPECT_TRUE(std::isnan(gone.measure_rows()[1].value[0]));
}

TEST(RunOut, FromTheReleaseAlongAndAcross) {
  Case c = flying();
  MeasureCase m = measure("run", "run_out");
  m.direction = Vec3{2, 0, 0};
  c.measure = {m};
  Simulation s(c, {});
  Measured out = run_to_end(s);
  double const t = s.time();
  EXPECT_NEAR(out["run.largest"].last, 3 * t, 1e-9);
  EXPECT_NEAR(out["run.mean"].last, (3 * 3 - 1) * t / 4, 1e-6);
  EXPECT_NEAR(out["run.sideways"].last, 2 * t, 1e-6);
  EXPECT_NEAR(out["run.sideways_spread"].last, 2 * t * std::sqrt(0.25), 1e-6);  // one of four: s = 2 t sqrt(3/4 / 3)
}

// Two pass at 0.1 and 0.3 s, a third stays before the plane: blocked from 0.3 s on, known to be after 0.25 s.
TEST(Blockage, IsAWaitThatIsTooLongWhileGrainsRemain) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{-0.1, 0, 0}, {-0.3, 0, 0}})};
  c.grains[0].insert.velocity = {1, 0, 0};
  GrainsCase stuck = grains_at("sphere", {{-0.5, 1, 0}});
  stuck.name = "stuck";
  c.grains.push_back(stuck);
  c.time.end = 1;
  c.time.step = 1e-3;
  c.output.every = 0.1;
  MeasureCase arch = measure("arch", "blockage");
  arch.point = Vec3{0, 0, 0};
  arch.normal = Vec3{1, 0, 0};
  arch.longer_than = 0.25;
  MeasureCase region = arch;
  region.name = "region";
  region.box = Box{{-1, -0.5, -1}, {1, 0.5, 1}};  // the third is not in it
  c.measure = {arch, region};
  Simulation s(c, {});
  Measured m = run_to_end(s);
  EXPECT_EQ(m["arch.count"].last, 1);
  EXPECT_EQ(m["arch.blocked"].last, 1);
  EXPECT_NEAR(m["arch.seconds"].last, 0.7, 3e-3);
  EXPECT_NEAR(m["arch.longest"].last, 0.7, 3e-3);
  EXPECT_NEAR(m["region.longest"].last, 0.2, 3e-3);
  EXPECT_EQ(m["region.count"].last, 0);
  for (MeasureRow const& row : s.measure_rows())
    if (row.measure == 0) {
      EXPECT_EQ(row.value[0], row.time > 0.56 ? 1 : 0) << row.time;
    }
}

}  // namespace
}  // namespace scree
