// flow_entries.cpp: rows 14 and 15 of the book: spheres that flow from a silo, press on its floor, and pack.
// Bounds are those of the sources named in each entry; what they give no number for is monotone or reported only.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/support/measures.h"
#include "tests/validation/book.h"
#include "tests/validation/loose_bed.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr d = bed_d, gravity = bed_gravity;
double constexpr weight = 2650 * M_PI / 6 * d * d * d * gravity;
double constexpr filled = 0.6;  // share of a poured bed that is grain, to count grains with

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

struct Flow {
  double early = 0, late = 0;  // grains a second in both halves of the window
  double head = 0;             // of what is left at the end [m]
};

// A square silo with a round hole of diameter D in its flat bottom, open from the start.
Flow discharge(double orifice, double width, int count, double from, double until) {
  Case c = soft_grains(0.5);
  c.grains = {grid_of(width / 2, width, count, 1)};
  WallCase sides = open_box({-width / 2, -width / 2, -1}, {width / 2, width / 2, 1});
  sides.open = {"-z", "+z"};
  WallCase bottom;
  bottom.name = "bottom", bottom.material = "rock";
  bottom.kind = WallKind::cone;  // nearly flat; its rim is round
  bottom.thickness = d;          // thinner, fast grains could not be told from those that pass through it
  bottom.from = {0, 0, -bottom.thickness / 2}, bottom.to = {0, 0, 1e-4 - bottom.thickness / 2};
  bottom.radius_from = orifice / 2 + bottom.thickness / 2, bottom.radius_to = 0.75 * width;
  c.wall = {sides, bottom};
  DeleteCase below;
  below.name = "out";
  below.plane = true;
  below.point = {0, 0, -2 * d};
  below.normal = {0, 0, 1};
  c.deletion = {below};
  c.time.end = until;
  Simulation s(c, {});
  double counted[3] = {};
  auto const gone = [&] { return static_cast<double>(s.impl().state.deleted[0]); };
  while (s.step() == RunState::running)
    for (int k = 0; k < 2; ++k)
      if (s.time() <= from + 0.5 * k * (until - from)) counted[k] = gone();
  counted[2] = gone();
  double const half = 0.5 * (until - from);
  Flow out{(counted[1] - counted[0]) / half, (counted[2] - counted[1]) / half};
  std::vector<double> top;
  for (int i = 0; i < s.bodies(); ++i)
    if (s.impl().state.is_active(i)) top.push_back(s.frame().position[i].z);
  std::sort(top.begin(), top.end());
  out.head = top[top.size() * 98 / 100];
  return out;
}

// The silo is two orifices wide, so that its walls act alike on all of them. Minutes: no smaller one is within the
// law's range, D/d >= 6 under a head of 2 D.
TEST(Validation, Row14BeverlooFlow) {
  if (!full()) GTEST_SKIP() << "minutes: part of the long variant";
  Entry book("validation", "14", "flow of spheres from a flat silo: exponent 2.5, whatever the head",
             "Beverloo, Leniger, van de Velde (1961)");
  double constexpr k = 1.4;                    // of the empty annulus, spheres
  double constexpr from = 0.15, until = 0.35;  // [s]: the bed has come down and flows
  double constexpr sunk = 4 * d;               // of the surface until then, and room to spare
  std::vector<double> x, y;
  for (double ratio : {6.0, 7.0, 8.0}) {
    double const orifice = ratio * d, width = 2 * orifice;
    int const count = static_cast<int>(width * width * (2 * orifice + sunk) * filled / (M_PI / 6 * d * d * d));
    Flow const f = discharge(orifice, width, count, from, until);
    std::string const what = fmt::format(", D/d = {:g}", ratio);
    double const rate = 0.5 * (f.early + f.late), open = orifice - k * d;
    // No source gives a tolerance; halves of a hundred grains and more scatter by a tenth if they come at random.
    book.relative("rate of the second half of the window over the first" + what, "", 1, f.late / f.early, 0.1);
    book.at_least("head at the end" + what, "D", f.head / orifice, 2);
    book.trend("rate" + what, "1/s", rate);
    // C in W = C rho_bulk sqrt(g) (D - k d)^2.5; 0.58 in the paper.
    book.trend("C at a bulk fraction of 0.6" + what, "",
               rate * M_PI / 6 * std::pow(d, 3) / (filled * std::sqrt(gravity) * std::pow(open, 2.5)));
    book.point("rate [1/s] against D - 1.4 d [m]", open, std::nan(""), rate);
    x.push_back(std::log(open)), y.push_back(std::log(rate));
  }
  double mx = 0, my = 0, xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mx += x[i] / x.size(), my += y[i] / x.size();
  for (std::size_t i = 0; i < x.size(); ++i) xx += (x[i] - mx) * (x[i] - mx), xy += (x[i] - mx) * (y[i] - my);
  book.absolute("exponent of D - 1.4 d", "", 2.5, xy / xx, 0.2);
}

// Share of the column's weight that the floor carries while it sinks slowly, so that the walls give what friction they
// have (at rest the share depends on how the silo was filled).
double share_on_floor(int count, double radius, double friction, double end) {
  Case c = soft_grains(friction);
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
    Case c = soft_grains(friction);
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
