// flow_entries.cpp: row 15 of the book: spheres that press on a silo's floor, and pack.
// Bounds are those of the sources named in each entry; what they give no number for is monotone or reported only.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/support/measures.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr d = 0.01, gravity = 9.81;  // [m], [m/s2]
double constexpr weight = 2650 * M_PI / 6 * d * d * d * gravity;

// Soft spheres: neither flow nor packing asks for stiff ones. The deepest contacts of a bed 26 d high carry some tenths
// of a newton, 4 % d.
Case soft_spheres(double friction) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.contact[0].kappa = 2e8;
  if (friction > 0) c.contact[0].friction = friction;
  c.contact[0].damping_ratio = 0.5;
  c.time.step = 1e-4;
  return c;
}

// Layers of a loose cubic grid over |x|, |y| <= half (and within `radius` of the axis), from z = 0.6 d up.
GrainsCase grid_of(double half, double radius, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-0.02 * d, 0.02 * d);
  GrainsCase g = grains_at("sphere", {}, d, 32);
  int const across = static_cast<int>(std::floor(2 * half / (1.05 * d)));
  double const cell = 2 * half / across;
  for (int k = 0; static_cast<int>(g.insert.position.size()) < count; ++k)
    for (int i = 0; i < across * across; ++i) {
      Vec3 const p{(i % across + 0.5) * cell - half, (i / across + 0.5) * cell - half, (0.6 + 1.05 * k) * d};
      if (std::hypot(p.x, p.y) > radius - 0.55 * d || static_cast<int>(g.insert.position.size()) == count) continue;
      g.insert.position.push_back(p + Vec3{u(random), u(random), u(random)});
    }
  g.count = count;
  return g;
}

// Share of the column's weight that the floor carries while it sinks slowly, so that the walls give what friction they
// have (at rest the share depends on how the silo was filled).
double share_on_floor(int count, double radius, double friction, double end) {
  Case c = soft_spheres(friction);
  c.time.step = 2e-4;  // slow: no impacts
  c.grains = {grid_of(radius, radius, count, 2)};
  WallCase bore;
  bore.name = "silo", bore.material = "rock";
  bore.kind = WallKind::cylinder;
  bore.from = {0, 0, -0.1}, bore.to = {0, 0, 2};
  bore.radius = radius;
  bore.open = {"from", "to"};
  WallCase floor = floor_at(0);
  floor.motion = MotionCase{};
  floor.motion->kind = MotionKind::translation;
  floor.motion->velocity = {0, 0, -0.25 * d};
  floor.motion->start = 0.6 * end;
  c.wall = {bore, floor};
  double constexpr rate = 10;  // carries rate v / g = 0.3 % of the weight while the floor sinks
  c.damping = DampingCase{rate};
  c.time.end = end;
  c.measure = {measure("floor", "wall_force")};
  c.measure[0].wall = "floor";
  c.measure[0].from = 0.8 * end;
  Simulation s(c, {});
  return -run_to_end(s).at("floor.z").mean / (count * weight);
}

TEST(Validation, Row15JanssenSilo) {
  Entry book(
      "validation", "15", "share of a column that a silo's floor carries",
      "Janssen (1895), as a trend: all of it without friction, less the higher the column and the rougher it is");
  double const radius = (full() ? 4 : 3) * d, end = full() ? 3 : 0.7;
  int const low = full() ? 400 : 60, high = full() ? 1600 : 180;
  std::string const curve = "share of the weight on the floor [-] against friction [-]";
  double before = 0;
  for (double friction : {0.0, 0.2, 0.5}) {
    double const share = share_on_floor(high, radius, friction, end);
    book.point(curve, friction, friction > 0 ? std::nan("") : 1, share);
    if (friction == 0)
      book.relative("without friction", "", 1, share, 0.01);  // statics; damping carries 0.3 %, the rest is motion
    else
      book.at_most(fmt::format("friction {:g}: less than with the one before", friction), "", share, before);
    before = share;
  }
  book.at_most("friction 0.5: less than of a lower column", "", before, share_on_floor(low, radius, 0.5, end));
}

// In the middle of a box, away from its ordered walls.
TEST(Validation, Row15SpherePacking) {
  Entry book("validation", "15b", "packing fraction of spheres in the middle of a box falls with friction",
             "a trend; random close packing of frictionless spheres is about 0.64");
  double const half = (full() ? 6.3 : 3.7) * d, core = half - 2 * d;
  int const count = full() ? 2400 : 450;
  double before = 1;
  for (double friction : {0.0, 0.5}) {
    Case c = soft_spheres(friction);
    c.grains = {grid_of(half, 2 * half, count, 3)};
    c.wall = {open_box({-half, -half, 0}, {half, half, 1})};
    c.damping = DampingCase{2};
    c.time.end = full() ? 1 : 0.3;
    MeasureCase m = measure("bed", "packing_fraction");
    m.box = Box{{-core, -core, 2 * d}, {core, core, full() ? 9 * d : 6 * d}};
    c.measure = {m};
    Simulation s(c, {});
    double const fraction = run_to_end(s).at("bed.fraction").last;
    book.trend(fmt::format("fraction, friction {:g}", friction), "", fraction);
    if (friction > 0) book.at_most("fraction with friction 0.5: less than without", "", fraction, before);
    before = fraction;
  }
}

}  // namespace
}  // namespace scree::book
