// measure_test.cpp: meters against answers known by formula: packing, coordination, angles, wall torque, discharge.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/measure_packing.h"
#include "core/measure_region.h"
#include "core/measure_surface.h"
#include "shapes/analytic_shapes.h"
#include "tests/support/measures.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = std::numbers::pi, g = 9.81;
double const sphere_volume = pi / 6 * 1e-3;  // d = 0.1 m
double const sphere_mass = 2650 * sphere_volume;

MeasureCase in_box(MeasureCase m, Vec3 min, Vec3 max) {
  m.box = Box{min, max};
  return m;
}

TEST(PackingFraction, WholeGrainsAreExactAndCutOnesAreWithinTheStatedError) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0.5, 0.5, 0.5}, {0.5, 0.5, 1.02}, {3, 0, 0}})};  // inside, cut, outside
  c.measure = {in_box(measure("bed", "packing_fraction"), {0, 0, 0}, {1, 1, 1}),
               in_box(measure("whole", "packing_fraction"), {0, 0, 0}, {1, 1, 0.8})};
  Measured m = measured_at_once(c);
  EXPECT_DOUBLE_EQ(m["whole.fraction"].last, sphere_volume / 0.8);
  EXPECT_EQ(m["whole.error"].last, 0);
  double const h = 0.03, cap = pi * h * h * (3 * 0.05 - h) / 3, share = cap / sphere_volume;  // of the second
  double const error = sphere_volume * std::sqrt(share * (1 - share) / 4096);
  EXPECT_NEAR(m["bed.error"].last, error, 0.05 * error);
  EXPECT_NEAR(m["bed.fraction"].last, sphere_volume + cap, error);
}

TEST(PackingFraction, SlicesAndCylindersShareTheSameVolume) {
  Case c = rock_case();
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 0.5}, {0, 0, 0.2}}, 0.1, 250)};
  MeasureCase m = measure("bed", "packing_fraction");
  m.cylinder = MeasureCylinder{{0, 0, 0}, {0, 0, 1}, 0.3};
  m.slices = 2;  // the border halves the first grain, the second is in the lower one
  c.measure = {m};
  Measured out = measured_at_once(c);
  double const volume = pi * 0.09, error = sphere_volume * 0.5 / 64 / (volume / 2);
  EXPECT_NEAR(out["bed.fraction"].last, 2 * sphere_volume / volume, 1e-12);  // cut by a slice only: none is lost
  EXPECT_NEAR(out["bed.slice_0"].last, 1.5 * sphere_volume / (volume / 2), error);
  EXPECT_NEAR(out["bed.slice_1"].last, 0.5 * sphere_volume / (volume / 2), error);
}

// Halves of an ellipsoid, at three sizes of the set: the error falls at least as that of random points does.
TEST(PackingFraction, PointsFillShapesEvenly) {
  Library library;
  library.shape.push_back(builtin_shape("ellipsoid:1:0.8:0.6"));
  for (int count : {256, 4096, 65536}) {
    auto const points = points_inside(library, library.shape[0], count);
    ASSERT_EQ(static_cast<int>(points.size()), count);
    for (int axis = 0; axis < 3; ++axis) {
      double below = 0;
      for (Vec3 const p : points) below += p[axis] < 0;
      EXPECT_NEAR(below / count, 0.5, 0.5 / std::sqrt(count)) << axis;
    }
  }
}

TEST(MeasureRegion, SegmentsAreClippedExactly) {
  MeasureCase box = in_box(measure("r", ""), {0, 0, 0}, {1, 2, 3}), tube = measure("r", "");
  tube.cylinder = MeasureCylinder{{0, 0, 0}, {0, 0, 2}, 1};
  MeasureRegion const b(box), t(tube);
  EXPECT_DOUBLE_EQ(b.share_of_segment({0.5, 1, 1}, {0.5, 1, 2}), 1);
  EXPECT_DOUBLE_EQ(b.share_of_segment({-1, 1, 1}, {1, 1, 1}), 0.5);
  EXPECT_DOUBLE_EQ(b.share_of_segment({-1, 1, 1}, {3, 1, 1}), 0.25);
  EXPECT_EQ(b.share_of_segment({-1, 1, 1}, {-1, 1, 2}), 0);
  EXPECT_EQ(b.share_of_segment({-1, 0.5, 1}, {0.5, -1, 1}), 0);  // past the corner
  EXPECT_DOUBLE_EQ(t.share_of_segment({-2, 0, 1}, {2, 0, 1}), 0.5);
  EXPECT_DOUBLE_EQ(t.share_of_segment({0, 0, -2}, {0, 0, 2}), 0.5);
  EXPECT_EQ(t.share_of_segment({-2, 1.01, 1}, {2, 1.01, 1}), 0);
  EXPECT_EQ(t.share_of_segment({2, 0, 0}, {2, 0, 1}), 0);
  EXPECT_DOUBLE_EQ(b.volume(), 6);
  EXPECT_DOUBLE_EQ(t.volume(), 2 * pi);
  EXPECT_TRUE(std::isinf(MeasureRegion(measure("r", "")).volume()));
}

// Three in a row, the first also on the floor; a fourth alone.
TEST(Coordination, CountsContactsThatCarryForce) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0, 0, 0.0499}, {0, 0, 0.1497}, {0, 0, 0.2495}, {1, 0, 0.1}})};
  c.wall = {floor_at(0)};
  c.measure = {measure("z", "coordination"), in_box(measure("low", "coordination"), {-1, -1, 0}, {0.5, 1, 0.1})};
  Measured m = measured_at_once(c);
  EXPECT_DOUBLE_EQ(m["z.grains"].last, 4 / 4.0);
  EXPECT_DOUBLE_EQ(m["z.walls"].last, 1 / 4.0);
  EXPECT_DOUBLE_EQ(m["z.together"].last, 5 / 4.0);
  EXPECT_DOUBLE_EQ(m["z.floating"].last, 1 / 4.0);
  EXPECT_DOUBLE_EQ(m["low.together"].last, 2);  // the lowest alone: one above it, and the floor
  c.measure[1].box = Box{{5, 5, 5}, {6, 6, 6}};
  EXPECT_TRUE(std::isnan(measured_at_once(c)["low.grains"].last));
}

// Tops on an exact cone, and grains below them at every depth.
TEST(HeapFit, FindsTheSlopeOfACone) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  double const tangent = std::tan(30 * pi / 180), bin = 0.1;
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 20000; ++i) {
    double const r = 1.5 * std::sqrt(unit(random)), turn = 2 * pi * unit(random), top = tangent * (1.5 - r);
    points.push_back({r, turn, top});
    points.push_back({r, turn, top * unit(random) - 2 * bin});
  }
  HeapFit const fit = fit_heap(points, true, bin, 0, 0.2, 0.8);
  EXPECT_NEAR(fit.line.slope, -tangent, 1e-12);
  EXPECT_LT(fit.line.rms, 1e-12);
  // A ridge: both flanks of the same angle, at another place along it.
  for (SurfacePoint& p : points) p.along *= p.across < pi ? 1 : -1;
  EXPECT_NEAR(fit_heap(points, false, bin, 0, 0.2, 0.8).line.slope, -tangent, 1e-12);
}

// Columns of touching spheres that stand on a floor and whose tops lie on a cone; above them two that meet in flight.
TEST(PileAngle, OfColumnsUnderACone) {
  double const tangent = std::tan(28 * pi / 180), foot = 0.0499;
  Case c = rock_case();
  std::vector<Vec3> position;
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j) {
      double const top = tangent * (1.01 - 0.101 * std::hypot(i, j));
      if (top < foot + 0.06) continue;  // too low for two that overlap by less than half
      int const more = static_cast<int>(std::ceil((top - foot) / 0.0999));
      for (int k = 0; k <= more; ++k) position.push_back({2 + 0.101 * i, 0.101 * j, foot + k * (top - foot) / more});
    }
  position.push_back({2, 0, 5});
  position.push_back({2.099, 0, 5});
  c.grains = {grains_at("sphere", position)};
  c.wall = {floor_at(0)};
  MeasureCase m = measure("pile", "pile_angle");
  m.through = Vec3{2, 0, 0};
  c.measure = {m, measure("own_axis", "pile_angle")};
  Measured out = measured_at_once(c);
  EXPECT_NEAR(out["pile.angle"].last, 28, 1e-6);
  EXPECT_NEAR(out["pile.height"].last, tangent * 1.01 + 0.05 - (foot - 0.05), 1e-9);
  EXPECT_NEAR(out["own_axis.angle"].last, 28, 1e-6);  // symmetric: the centre of mass is on the axis
}

// Layers of grains parallel to a tilted surface in a drum; a grain in flight above.
Case drum_with_surface(double degrees, double rate) {
  Case c = rock_case();
  WallCase drum;
  drum.name = "drum";
  drum.material = "rock";
  drum.kind = WallKind::cylinder;
  drum.from = {0, -0.3, 0.2}, drum.to = {0, 0.3, 0.2};
  drum.radius = 1;
  MotionCase motion;
  motion.axis = {0, 1, 0};
  motion.through = {0, 0, 0.2};
  motion.rate = rate;
  drum.motion = motion;
  c.wall = {drum};
  double const tangent = std::tan(degrees * pi / 180);
  std::vector<Vec3> position;
  for (int i = -5; i <= 5; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = 0; k < 2; ++k) {
        double const x = 0.1 * i + 0.05;
        position.push_back({x, 0.2 * j, 0.2 - 0.1 + tangent * x - 0.2 * k});
      }
  position.push_back({0.04, 0.01, 0.9});
  c.grains = {grains_at("sphere", position, 0.09)};
  MeasureCase m = measure("bed", "surface_angle");
  m.wall = "drum";
  m.bin = 0.1;
  c.measure = {m};
  return c;
}

TEST(SurfaceAngle, IsThatOfTheTopLayerAndPositiveUpTheRisingSide) {
  // Rate < 0 about y moves the bottom to +x: grains climb on that side.
  EXPECT_NEAR(measured_at_once(drum_with_surface(27, -0.6))["bed.angle"].last, 27, 1e-6);
  EXPECT_NEAR(measured_at_once(drum_with_surface(27, 0.6))["bed.angle"].last, -27, 1e-6);
  EXPECT_NEAR(measured_at_once(drum_with_surface(-27, 0.6))["bed.angle"].last, 27, 1e-6);
  EXPECT_NEAR(measured_at_once(drum_with_surface(27, -0.6))["bed.offset"].last, -0.1, 1e-9);
}

// A sphere pressed into walls, at a lever arm: F = pi R kappa x^2.
TEST(WallTorque, ByHandOnAPlaneAndOnABody) {
  double const kappa = 1e9, overlap = 1e-3, force = pi * 0.05 * kappa * overlap * overlap, arm = 0.7;
  for (bool moving : {false, true}) {
    Case c = rock_case();
    c.contact[0].kappa = kappa;
    c.grains = {grains_at("sphere", {{arm, 0.2, 0.05 - overlap}})};
    c.wall = {floor_at(0)};
    if (moving) c.wall[0].motion = later();
    MeasureCase torque = measure("turn", "wall_torque"), push = measure("push", "wall_force");
    torque.wall = push.wall = "floor";
    torque.axis = Vec3{0, 2, 0};
    torque.through = Vec3{};
    c.measure = {torque, push};
    Measured m = measured_at_once(c);
    // Grains on the wall: (arm, 0, 0) x (0, 0, -F) = (0, arm F, 0); what holds it is the opposite.
    EXPECT_NEAR(m["turn.torque"].last, -arm * force, 1e-6 * arm * force) << moving;
    EXPECT_EQ(m["turn.power"].last, 0);
    EXPECT_NEAR(m["push.z"].last, -force, 1e-6 * force) << moving;
    EXPECT_NEAR(m["push.size"].last, force, 1e-6 * force);
  }
}

Case turning_drum() {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -g};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.5;
  c.contact[0].rolling = RollingCase{0.1};
  std::vector<Vec3> position;
  for (int i = -2; i <= 2; ++i)
    for (int j = -1; j <= 1; ++j) position.push_back({0.11 * i, 0.11 * j, -0.3 + 0.01 * i});
  c.grains = {grains_at("sphere", position)};
  WallCase drum;
  drum.name = "drum";
  drum.material = "rock";
  drum.kind = WallKind::cylinder;
  drum.from = {0, -0.2, 0}, drum.to = {0, 0.2, 0};
  drum.radius = 0.5;
  MotionCase motion;
  motion.axis = {0, 1, 0};
  motion.rate = -2;
  drum.motion = motion;
  c.wall = {drum};
  c.time.end = 0.8;
  MeasureCase torque = measure("drive", "wall_torque");
  torque.wall = "drum";
  torque.every = 0.05;
  c.measure = {torque};
  return c;
}

TEST(WallTorque, PowerIsTorqueTimesRateAndItsIntegralIsTheLedgersWork) {
  Simulation s(turning_drum(), {});
  Measured m = run_to_end(s);
  double work = 0, before = 0;
  for (MeasureRow const& row : s.measure_rows()) {
    EXPECT_NEAR(row.value[1], row.value[0] * -2, 1e-9 * std::abs(row.value[1]));
    work += row.value[1] * (row.time - before);
    before = row.time;
  }
  double const wall_work = s.ledger().wall_work;
  EXPECT_GT(wall_work, 0.1);  // it lifts grains: of the order of m g per 0.1 m
  EXPECT_NEAR(m["drive.work"].last, wall_work, 0.01 * wall_work);
  EXPECT_NEAR(work, wall_work, 0.01 * wall_work);
}

// The same with grains whose contacts are nodes, and a turning box: five faces, each a body.
TEST(WallTorque, SumsNodesAndAllFacesOfAMovingBox) {
  Case c = turning_drum();
  c.wall[0] = open_box({-0.2, -0.2, -0.2}, {0.2, 0.2, 0.6});
  MotionCase& motion = c.wall[0].motion.emplace();
  motion.axis = {0, 1, 0};
  motion.through = {-1, 0, 0};
  motion.rate = -0.5;  // lifts what is at +x
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0, 0, -0.15}, {-0.12, 0.1, -0.15}, {0.12, 0, -0.14}}, 0.1, 250)};
  c.measure[0].wall = "container";
  c.time.end = 0.6;
  Simulation s(c, {});
  Measured m = run_to_end(s);
  double const wall_work = s.ledger().wall_work;
  EXPECT_GT(wall_work, 3 * sphere_mass * g * 0.8 * std::sin(0.5 * 0.6));  // all are lifted by about that much
  EXPECT_NEAR(m["drive.work"].last, wall_work, 0.01 * wall_work);
  MeasureRow const row = s.measure_rows().back();
  EXPECT_NEAR(row.value[1], row.value[0] * -0.5, 1e-9 * std::abs(row.value[1]));
}

// A row of grains at speed v, s apart, passes at v / s.
Case stream(double v, double spacing) {
  Case c = rock_case();
  std::vector<Vec3> position;
  for (int i = 0; i < 12; ++i) position.push_back({-0.05 - i * spacing, 0, 0});
  position.push_back({-0.1, 3, 0});  // passes far from the point
  c.grains = {grains_at("sphere", position)};
  c.grains[0].insert.velocity = {v, 0, 0};
  c.time.end = 10 * spacing / v;
  c.time.step = c.time.end / 1000;
  MeasureCase through = measure("out", "discharge_rate");
  through.point = Vec3{0, 0, 0};
  through.normal = Vec3{2, 0, 0};
  through.radius = 1;
  through.every = 5 * spacing / v;
  c.measure = {through};
  return c;
}

TEST(DischargeRate, OfARowThroughAPlaneAndOutOfTheScene) {
  double const v = 2, spacing = 0.2;
  Case c = stream(v, spacing);
  DeleteCase end;
  end.name = "end";
  end.plane = true;
  end.normal = {-1, 0, 0};
  c.deletion = {end};
  MeasureCase gone = measure("gone", "discharge_rate");
  gone.deletion = "end";
  gone.every = c.measure[0].every;
  c.measure.push_back(gone);
  Case open = c;
  open.deletion.clear();
  open.measure.pop_back();
  Simulation with(c, {}), without(open, {});
  Measured m = run_to_end(with), n = run_to_end(without);
  EXPECT_NEAR(n["out.number_rate"].mean, v / spacing, 1e-9);
  EXPECT_NEAR(n["out.mass_rate"].mean, sphere_mass * v / spacing, 1e-9);
  EXPECT_EQ(n["out.number_rate"].samples, 2);
  EXPECT_EQ(n["out.number"].last, 10);
  EXPECT_NEAR(m["gone.number"].last, 11, 0);  // the far one, too
  EXPECT_NEAR(m["gone.mass"].last, 11 * sphere_mass, 1e-9);
  EXPECT_NEAR(m["gone.number_rate"].mean, 11 / c.time.end, 1e-9);
}

TEST(DischargeRate, WhatComesBackIsTakenOff) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -g};
  c.grains = {grains_at("sphere", {{0, 0, -0.1}})};
  c.grains[0].insert.velocity = {0, 0, 3};
  c.time.end = 0.3;
  MeasureCase up = measure("up", "discharge_rate");
  up.point = Vec3{};
  up.normal = Vec3{0, 0, 1};
  up.every = 0.15;
  c.measure = {up};
  Simulation s(c, {});
  run_to_end(s);
  auto rows = s.measure_rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].value[3], 1);
  EXPECT_EQ(rows[1].value[3], 1);
  c.time.end = 0.75;  // 3 t - g t^2 / 2 = 0.1 again at t = 0.58
  c.measure[0].every = 0.75;
  Simulation back(c, {});
  EXPECT_EQ(run_to_end(back)["up.number"].last, 0);
}

}  // namespace
}  // namespace scree
