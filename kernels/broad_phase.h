// broad_phase.h: pairs of grains whose boxes and balls overlap, and of grains and walls.
// An implicit bounding volume hierarchy: leaves in Morton order, level k node i covers leaves [i 2^k, (i+1) 2^k).
// SPDX-License-Identifier: Apache-2.0
#pragma once

// No pointers, no atomics, near-linear for any mix of sizes, the same pairs in the same order for any thread count.
// With worlds (SceneView) leaves stand world by world, and no walk enters a part that has none of its own.

#include <cstdint>
#include <vector>

#include "kernels/base/queue.h"
#include "kernels/views.h"

namespace scree {

struct Pair {
  int a;  // grain
  int b;  // grain > a, wall (behind all grains), or -1 - plane

  SCREE_HD bool with_plane() const { return b < 0; }
  SCREE_HD int plane() const { return -1 - b; }
  SCREE_HD friend bool operator==(Pair p, Pair q) { return p.a == q.a && p.b == q.b; }
};

// Scratch of the broad phase; reuse it between calls.
struct BroadPhase {
  std::vector<std::uint64_t> key;
  std::vector<int> order;         // leaf -> body
  std::vector<Box> node;          // all levels, leaves first
  std::vector<int> level_first;   // of `node`
  std::vector<int> count, first;  // pairs a body opens
  std::vector<Pair> pair;         // result, ordered by (a, planes first in ascending index, then b)
};

// Balls that hold all of a grain that its box does; of the eight corners where two cubes meet and no balls do, they
// leave half of a sphere's pairs. Empty: boxes alone decide.
struct BoundingBalls {
  Span<const Vec3> centre;    // [m] (n_bodies)
  Span<const double> radius;  // [m] (n_bodies)
};

// box: of all solids (n_solids). Walls are few and large: each grain looks at every one of them.
void find_pairs(Queue const& queue, SceneView const& scene, Span<const Box> box, BoundingBalls const& balls,
                BroadPhase& work);

}  // namespace scree
