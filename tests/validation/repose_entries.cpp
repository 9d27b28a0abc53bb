// repose_entries.cpp: row 15 of the book: the slopes that grains keep, at rest behind a ledge and in a turning drum.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/simulation_impl.h"
#include "tests/support/measures.h"
#include "tests/validation/book.h"
#include "tests/validation/loose_bed.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr d = bed_d;

// A wall that grains slide along, so that only their own friction and that of the floor hold a slope.
WallCase glass_plane(std::string const& name, Vec3 point, Vec3 normal) {
  WallCase w;
  w.name = name, w.material = "glass";
  w.point = point, w.normal = normal;
  return w;
}

struct Grain {
  std::string shape = "sphere";
  int nodes = 32;
  double step = 2e-4;       // half the critical one [s]
  double pitch = 1.05 * d;  // of the grid they start on: none overlaps, whichever way it is turned
};

Case between_glass(Grain const& grain, double friction) {
  Case c = soft_grains(friction);
  c.contact[0].kappa = 1e8;  // slow, no impacts: softer still
  c.time.step = grain.step;
  c.material.push_back({"glass", 2650});
  ContactCase slippery = c.contact[0];
  slippery.pair = {"rock", "glass"};
  slippery.friction.reset();
  c.contact.push_back(slippery);
  return c;
}

// Angle of repose [deg] of what stays behind a ledge: a block of grains on a rough floor loses its front wall, and
// whatever rolls over the edge of the floor is gone.
double angle_behind_ledge(Grain const& grain, double friction, double end) {
  double const length = 14 * d, width = 6 * d, height = 12 * d;
  Case c = between_glass(grain, friction);
  int const count = static_cast<int>(length * width * height / std::pow(grain.pitch, 3));
  c.grains = {loose_grid(grain.shape, grain.nodes, {{0, 0, 0}, {length, width, 1}}, grain.pitch, count, 4,
                         [](Vec3) { return true; })};
  c.wall = {floor_at(0), glass_plane("back", {0, 0, 0}, {1, 0, 0}), glass_plane("left", {0, 0, 0}, {0, 1, 0}),
            glass_plane("right", {0, width, 0}, {0, -1, 0})};
  // A lip holds the lowest grains, which would roll off a flat floor.
  WallCase lip = glass_plane("lip", {}, {0, 0, 1});
  lip.material = "rock";
  lip.kind = WallKind::box;
  lip.inside = false;
  lip.min = {length, -d, -d}, lip.max = {length + d, width + d, 2 * d};
  c.wall.push_back(lip);
  DeleteCase over;
  over.name = "over";
  over.plane = true;
  over.point = {length + d, 0, 0};
  over.normal = {-1, 0, 0};
  c.deletion = {over};
  c.time.end = end;
  MeasureCase m = measure("heap", "pile_angle");
  m.direction = Vec3{1, 0, 0};
  m.through = Vec3{0, width / 2, 0};
  m.every = 0.1;
  c.measure = {m};
  Simulation s(c, {});
  return run_to_end(s).at("heap.angle").last;
}

// Dynamic angle [deg] of a drum, a third full, at this Froude number w^2 R / g: mean of the second of two equal turns.
double angle_in_drum(Grain const& grain, double friction, double froude, double turn) {
  double const radius = (full() ? 10 : 5) * d, width = (full() ? 5 : 2.5) * d;
  Case c = between_glass(grain, friction);
  double const inner = radius - 0.6 * grain.pitch;
  int const count = static_cast<int>(0.35 * M_PI * radius * radius * width * 0.6 / (M_PI / 6 * d * d * d));
  c.grains = {loose_grid(grain.shape, grain.nodes, {{-inner, -width / 2, -inner}, {inner, width / 2, inner}},
                         grain.pitch, count, 5, [&](Vec3 p) { return std::hypot(p.x, p.z) < inner; })};
  WallCase drum;
  drum.name = "drum", drum.material = "rock";
  drum.kind = WallKind::cylinder;
  drum.from = {0, -width, 0}, drum.to = {0, width, 0};
  drum.radius = radius;
  drum.open = {"from", "to"};
  drum.motion = MotionCase{};
  drum.motion->axis = {0, 1, 0};
  drum.motion->rate = std::sqrt(froude * bed_gravity / radius);
  c.wall = {drum, glass_plane("left", {0, -width / 2, 0}, {0, 1, 0}),
            glass_plane("right", {0, width / 2, 0}, {0, -1, 0})};
  double const end = 0.1 + 2 * turn / drum.motion->rate;  // [s]
  c.time.end = end;
  MeasureCase m = measure("bed", "surface_angle");
  m.wall = "drum";
  m.every = 0.02;
  m.from = 0.5 * (end + 0.1);
  c.measure = {m};
  Simulation s(c, {});
  return run_to_end(s).at("bed.angle").mean;
}

Grain superball(double exponent) { return {fmt::format("superellipsoid:1:1:1:{:g}", exponent), 300, 8e-5, 1.3 * d}; }

// Adds the angles and that each is larger than the one before it.
void add_rising(Entry& book, std::string const& of, std::vector<std::string> const& what,
                std::vector<double> const& angle) {
  for (std::size_t i = 0; i < angle.size(); ++i) {
    book.trend(of + ", " + what[i], "deg", angle[i]);
    if (i > 0) book.at_least(of + ", " + what[i] + ": over " + what[i - 1], "deg", angle[i] - angle[i - 1], 0);
  }
}

TEST(Validation, Row15AngleOfRepose) {
  if (!full()) GTEST_SKIP() << "minutes: part of the long variant";
  Entry book("validation", "15c", "angle of repose behind a ledge",
             "a trend: steeper with friction and with angularity");
  std::vector<std::string> what;
  std::vector<double> angle;
  for (double friction : {0.1, 0.3, 0.8}) {
    what.push_back(fmt::format("friction {:g}", friction));
    angle.push_back(angle_behind_ledge({}, friction, 1.2));
  }
  add_rising(book, "spheres", what, angle);
  what.clear(), angle.clear();
  for (double exponent : {0.99, 0.6, 0.4}) {
    what.push_back(fmt::format("exponent {:g}", exponent));
    angle.push_back(angle_behind_ledge(superball(exponent), 0.3, 1.2));
  }
  add_rising(book, "superballs, friction 0.3", what, angle);
}

TEST(Validation, Row15DrumAngle) {
  Entry book("validation", "15d", "angle of the bed of a turning drum",
             "a trend: steeper with friction and angularity, and in a fast drum");
  double const turn = full() ? 3 : 1.5;  // [rad]
  std::vector<std::string> what;
  std::vector<double> angle;
  for (double friction : full() ? std::vector{0.05, 0.2, 0.6} : std::vector{0.05, 0.6}) {
    what.push_back(fmt::format("friction {:g}", friction));
    angle.push_back(angle_in_drum({}, friction, 0.05, turn));
  }
  add_rising(book, "spheres, Froude 0.05", what, angle);
  if (!full()) return;
  // A slow bed rolls at one angle, whatever the speed: only the ends are compared.
  angle.clear();
  for (double froude : {0.01, 0.05, 0.2, 0.5}) {
    angle.push_back(angle_in_drum({}, 0.6, froude, turn));
    book.trend(fmt::format("spheres, friction 0.6, Froude {:g}", froude), "deg", angle.back());
    book.point("angle [deg] against Froude number [-]", froude, std::nan(""), angle.back());
  }
  book.at_least("spheres, friction 0.6, Froude 0.5: over Froude 0.01", "deg", angle.back() - angle.front(), 0);
  what.clear(), angle.clear();
  for (double exponent : {0.99, 0.6, 0.4}) {
    what.push_back(fmt::format("exponent {:g}", exponent));
    angle.push_back(angle_in_drum(superball(exponent), 0.3, 0.05, 1.5));
  }
  add_rising(book, "superballs, friction 0.3, Froude 0.05", what, angle);
}

}  // namespace
}  // namespace scree::book
