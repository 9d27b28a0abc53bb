// pile_tiles.h: a pile of grains at rest, and any number of copies of it side by side: large scenes without their fall.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation.h"

namespace scree {

// Grains at rest on the floor z = 0 under their own weight, nothing else near.
struct Pile {
  Case c;                         // of the fall
  std::vector<Vec3> position;     // [m] (n)
  std::vector<Quat> orientation;  // body -> world (n)
  std::vector<int> shape;         // index into the entry's shapes, patterns written out (n)
  Box box;                        // of the bounding spheres [m]
};

// Lets `c` run to its end: one entry of grains, a floor at z = 0.
Pile settle_pile(Case const& c, int threads);

// The case of a pile: `heap_case` on a floor without sides. Spheres get rolling resistance, or they would roll away.
Case pile_case(Case heap);

// `tiles` copies in a square, a diameter between their boxes: every grain has the neighbours it has in the pile. Bodies
// stand in random order, as after a long flow, or tile by tile. Contact histories are not taken along: friction builds
// up anew within a few steps.
Case tiled_case(Pile const& pile, int tiles, bool shuffled, std::uint64_t seed);

}  // namespace scree
