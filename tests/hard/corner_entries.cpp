// corner_entries.cpp: a sharp corner on a flat face, anywhere between its nodes, whichever body comes first.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard/course.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr d = 0.1, kappa = 2e6 / (M_PI * 0.025 * 1e-3);  // [m], [N/m3] of rock_case

// Rotation that takes the cube's diagonal (1, 1, 1) to -z: a corner looks down.
Quat corner_down() {
  Vec3 const from = normalized(Vec3{1, 1, 1}), axis = normalized(cross(from, {0, 0, -1}));
  return quat_from_rotation_vector(axis * std::acos(-from.z));
}

// A cube that falls corner first on the face of a slab, both free.
Case corner_case(double x, double y, bool slab_first, double speed) {
  Case c = rock_case();
  c.limits.overlap = 0.5;
  double const half = 0.5 * d * std::cbrt(M_PI / 6), thick = 0.5 * d * std::cbrt(M_PI / 6 / 16);
  GrainsCase cube = grains_at("box:1:1:1", {{x, y, thick + std::sqrt(3) * half + 1e-4}}, d, 2000);
  cube.name = "cube";
  cube.insert.quaternion = {corner_down()};
  cube.insert.velocity = {0, 0, -speed};
  GrainsCase slab = grains_at("box:4:4:1", {{0, 0, 0}}, d, 2000);
  slab.name = "slab";
  c.grains = slab_first ? std::vector{slab, cube} : std::vector{cube, slab};
  c.time.end = 0.02 / speed;
  return c;
}

TEST(Hard, CornerOnAFlatFace) {
  Entry book("hard", "corner", "cube's corner on a slab's face between its nodes, from either side",
             "energy of a corner in Winkler's law: 3/8 kappa h^4, all of it in one grain's nodes at most");
  double const speed = 1, mass = 2650 * M_PI / 6 * d * d * d;
  double least = 1, deepest = 0, differ = 0, gain = 0, open = 0;
  // Off the slab's centre it turns away, so that the reduced mass below is an upper bound.
  for (int k = 0; k < (full() ? 40 : 6); ++k) {
    double const x = 0.15 * d * std::sin(2.4 * k), y = 0.15 * d * std::cos(1.7 * k);
    double overlap[2];
    for (bool slab_first : {false, true}) {
      Simulation s(corner_case(x, y, slab_first, speed), {});
      Course const run = follow(s);
      EXPECT_EQ(run.stopped, "");
      overlap[slab_first] = run.overlap;
      least = std::min(least, run.overlap), deepest = std::max(deepest, run.overlap);
      gain = std::max(gain, run.gained()), open = std::max(open, run.unaccounted());
      EXPECT_GT(s.frame().velocity[slab_first].z, s.frame().velocity[!slab_first].z) << "they did not part";
    }
    differ = std::max(differ, std::abs(overlap[0] / overlap[1] - 1));
  }
  // Force 3/2 kappa h^2 h of a whole corner; one side's nodes alone would carry half of it: h is 2^(1/4) larger.
  double const h = std::pow(0.5 * (mass / 2) * speed * speed / (0.375 * kappa), 0.25) / d;
  // Nodes stand within 0.02 d along edges: so much deeper may a corner be before the next ones see the face.
  book.at_most("deepest overlap, two masses in line, half the nodes", "d", deepest, std::pow(2, 0.25) * h + 0.02);
  book.at_least("contact is found: least of the deepest overlaps", "d", least, 0.5 * h);
  book.at_most("overlap, one order of bodies over the other - 1", "", differ, 1e-6);
  book.at_most("energy gained, of the energy moved", "", gain, 1e-3);
  book.at_most("not accounted for, of the energy moved", "", open, 1e-3);
}

}  // namespace
}  // namespace scree::book
