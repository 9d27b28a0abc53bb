// loose_bed.h: soft grains on a loose grid, from which the flows, beds and heaps of the book come down.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "tests/support/cases.h"

namespace scree::book {

double constexpr bed_d = 0.01, bed_gravity = 9.81;  // [m], [m/s2]

// Neither flow nor packing asks for stiff grains. The deepest contacts of a bed 26 d high carry some tenths of a
// newton, 4 % d.
inline Case soft_grains(double friction) {
  Case c = testing::rock_case();
  c.gravity = Vec3{0, 0, -bed_gravity};
  c.contact[0].kappa = 2e8;
  if (friction > 0) c.contact[0].friction = friction;
  c.contact[0].damping_ratio = 0.5;
  c.time.step = 1e-4;
  return c;
}

// `count` grains of 0.8 to 1 d (equal ones would stack like cannon balls) on a cubic grid, `pitch` apart, that fills
// the floor of `room` from 0.6 pitch above it, shaken by 0.02 d. within: which places of the grid are taken.
template <class Within>
GrainsCase loose_grid(std::string const& shape, int nodes, Box room, double pitch, int count, std::uint64_t seed,
                      Within const& within) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-0.02 * bed_d, 0.02 * bed_d);
  GrainsCase g = testing::grains_at(shape, {}, bed_d, nodes);
  g.insert.orientation = Orientation::random;
  g.evaluator = shape == "sphere" ? Evaluator::net : Evaluator::grid;  // formulas of superellipsoids are slow
  g.least_diameter = 0.8 * bed_d;
  int across[2];
  double cell[2];
  for (int i = 0; i < 2; ++i) {
    across[i] = static_cast<int>(std::floor((room.max[i] - room.min[i]) / pitch));
    cell[i] = (room.max[i] - room.min[i]) / across[i];
  }
  for (int k = 0; static_cast<int>(g.insert.position.size()) < count && k < 1000; ++k)
    for (int j = 0; j < across[1]; ++j)
      for (int i = 0; i < across[0]; ++i) {
        Vec3 const p = room.min + Vec3{(i + 0.5) * cell[0], (j + 0.5) * cell[1], (0.6 + k) * pitch};
        if (!within(p) || static_cast<int>(g.insert.position.size()) == count) continue;
        g.insert.position.push_back(p + Vec3{u(random), u(random), u(random)});
      }
  g.count = static_cast<int>(g.insert.position.size());
  return g;
}

}  // namespace scree::book
