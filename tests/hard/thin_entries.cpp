// thin_entries.cpp: needles 50:1 and plates 1:20: piled at up to 8 m/s nothing is pulled through; faster is stopped.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard/course.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr d = 0.05;  // [m]

struct Thin {
  char const* name;
  char const* shape;
  double thickness;  // [d]: of the box with volume pi/6
  bool crossed;      // laid crosswise, like logs
};
double const needle = std::cbrt(M_PI / 6 / 50), plate = std::cbrt(M_PI / 6 / 400);
Thin const thin[] = {{"needles 50:1", "box:50:1:1", needle, true}, {"plates 1:20", "box:20:20:1", plate, false}};

// A pile that falls as one: each body a little turned and tilted, clear of the next one by a tenth of its thickness at
// the ends of what the tilt lifts.
Case pile(Thin const& t, int bodies, double speed) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].damping_ratio = 0.5;
  c.contact[0].friction = 0.4;
  c.limits.overlap = 0.05;
  c.time.safety =
      0.15;  // whole faces come into contact within one step: at 0.3 the ledger of the plates is open by 0.26 %
  GrainsCase g = grains_at(t.shape, {}, d, full() ? 4000 : 1500);
  double z = 0;
  for (int k = 0; k < bodies; ++k) {
    double const tilt = (k % 2 ? 0.004 : -0.003), lift = (t.crossed ? 11 : 2.2) * d * std::abs(tilt);
    z += t.thickness * d + lift;
    g.insert.position.push_back({0.2 * d * std::sin(2.0 * k), 0.2 * d * std::cos(3.0 * k), z - t.thickness * d / 2});
    double const turn = t.crossed ? (k % 2) * M_PI / 2 + 0.05 * k : 0.2 * k;
    g.insert.quaternion.push_back(quat_from_rotation_vector({0, 0, turn}) * quat_from_rotation_vector({0, tilt, 0}));
    z += 0.1 * t.thickness * d;
  }
  g.count = bodies;
  g.insert.velocity = {0, 0, -speed};
  c.grains = {g};
  c.wall = {floor_at(0)};
  return c;
}

TEST(Hard, NeedlesAndPlatesPile) {
  Entry book("hard", "thin", "needles and plates piled at 8 m/s",
             "no pull-through, no energy gain; closed forms of the box");
  for (Thin const& t : thin) {
    Case c = pile(t, full() ? 8 : 3, 8);
    // A step is 2e-7 s, by the needle's small moment about its axis: 0.5 s are minutes. Damped by 50/s a pile falls at
    // 0.2 m/s and is not at rest by then (RESULTS.md).
    c.time.end = full() ? 0.5 : 0.02;
    if (full()) c.time.settle = SettleCase{50, 0.05, 1e-8, 0.02};
    Simulation s(c, {});
    Course const run = follow(s);
    add_sound_rows(book, t.name, run, 1e-3, 1e-3);
    book.at_most(std::string(t.name) + ": worst overlap", "d", run.overlap, c.limits.overlap);
    book.at_most(std::string(t.name) + ": deepest, in half thicknesses", "", run.depth, 0.8);
    // Nobody changes places: that is what being pulled through would look like.
    Frame const f = s.frame();
    double least = f.position[0].z;
    for (std::size_t k = 0; k + 1 < f.position.size(); ++k)
      least = std::min(least, f.position[k + 1].z - f.position[k].z);
    if (!full())
      book.at_least(std::string(t.name) + ": least distance of two neighbours", "thicknesses",
                    least / (t.thickness * d), 0.4);
    if (full()) book.at_most(std::string(t.name) + ": kinetic energy at rest", "m g d", run.kinetic, 1e-8);
  }
}

// Edge on edge, crosswise, is the worst that two thin bodies can meet. Where the law gives way is told by the run
// itself, with the bodies' names; until then they part on the sides they came from.
TEST(Hard, ThinBodiesCrosswiseReboundOrAreStopped) {
  Entry book("hard", "thin-cross", "needles and plates meet crosswise, edge on edge, at 2 to 64 m/s",
             "rebound, or a stop that names the bodies");
  for (Thin const& t : thin) {
    double const reach = t.crossed ? t.thickness / 2 : 20 * t.thickness / 2;  // of the side that meets the other [d]
    Quat const low = t.crossed ? Quat{} : quat_from_rotation_vector({M_PI / 2, 0, 0});
    Quat const high = quat_from_rotation_vector({0, 0, M_PI / 2}) * low;
    double held = 0, through = 0;
    for (double speed = 2; speed <= 64; speed *= 2) {
      Case c = rock_case();
      c.limits.overlap = 0.5;  // so that only the thin parts can stop it
      GrainsCase g = grains_at(t.shape, {{0.013 * d, 0.007 * d, 0}, {0, 0, (2 * reach + 0.01) * d}}, d, 2000);
      g.insert.quaternion = {low, high};
      c.grains = {g, g};
      c.grains[0].insert.position.pop_back(), c.grains[0].insert.quaternion.pop_back();
      c.grains[1].insert.position.erase(c.grains[1].insert.position.begin());
      c.grains[1].insert.quaternion.erase(c.grains[1].insert.quaternion.begin());
      c.grains[0].count = c.grains[1].count = 1;
      c.grains[1].name = "upper";
      c.grains[1].insert.velocity = {0, 0, -speed};
      c.time.end = 0.02 / speed;
      Simulation s(c, {});
      Course const run = follow(s);
      EXPECT_TRUE(run.finite);
      if (run.stopped.empty()) {
        bool const parted = s.frame().velocity[1].z > s.frame().velocity[0].z;
        bool const above = s.frame().position[1].z - s.frame().position[0].z > 1.9 * reach * d;
        through += !(parted && above);
        held = std::max(held, speed);
        EXPECT_LT(run.gained(), 1e-3) << t.name << " at " << speed;
      } else {
        EXPECT_TRUE(says(run.stopped, "half thicknesses inside each other")) << t.name << ": " << run.stopped;
        EXPECT_TRUE(says(run.stopped, "grain 0 (" + std::string(t.shape) + ")")) << run.stopped;
      }
    }
    book.at_most(std::string(t.name) + ": pulled through without a word", "", through, 0);
    book.trend(std::string(t.name) + ": fastest that rebounds", "m/s", held);
  }
}

}  // namespace
}  // namespace scree::book
