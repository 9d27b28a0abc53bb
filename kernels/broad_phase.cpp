// broad_phase.cpp: see broad_phase.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/broad_phase.h"

#include <algorithm>

#include "kernels/base/parallel.h"
#include "kernels/base/sort_scan.h"

namespace scree {
namespace {

SCREE_HD std::uint64_t spread_bits(std::uint64_t v) {  // two zero bits between the lowest 21 bits
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

// Without branches: nobody can foretell which of the six sides parts two boxes.
SCREE_HD bool overlap(Box const& a, Box const& b) {
  return (static_cast<int>(a.min.x <= b.max.x) & static_cast<int>(b.min.x <= a.max.x) &
          static_cast<int>(a.min.y <= b.max.y) & static_cast<int>(b.min.y <= a.max.y) &
          static_cast<int>(a.min.z <= b.max.z) & static_cast<int>(b.min.z <= a.max.z)) != 0;
}

struct MortonKey {
  Span<const Box> box;
  Box all;
  Span<const int> world_of;
  int world_bits;
  Span<std::uint64_t> key;
  Span<int> order;

  SCREE_HD void operator()(int i) const {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      double const width = all.max[k] - all.min[k];
      double t = width > 0 ? (0.5 * (box[i].min[k] + box[i].max[k]) - all.min[k]) / width : 0;
      t = t > 0 ? (t < 1 ? t : 1) : 0;  // a NaN box becomes 0; the watch reports it
      code |= spread_bits(static_cast<std::uint64_t>(t * 2097151)) << k;
    }
    // Worlds first: what is left of the 63 bits still orders a world's own bodies.
    if (!world_of.empty()) code = code >> world_bits | static_cast<std::uint64_t>(world_of[i]) << (63 - world_bits);
    key[i] = code;
    order[i] = i;
  }
};

struct LeafBox {
  Span<const Box> box;
  Span<const int> order;
  Span<Box> node;

  SCREE_HD void operator()(int i) const { node[i] = box[order[i]]; }
};

struct ParentBox {
  Span<const Box> child;
  Span<Box> parent;

  SCREE_HD void operator()(int i) const {
    Box b = child[2 * i];
    if (2 * i + 1 < child.size()) {
      Box const& c = child[2 * i + 1];
      for (int k = 0; k < 3; ++k) {
        b.min[k] = b.min[k] < c.min[k] ? b.min[k] : c.min[k];
        b.max[k] = b.max[k] > c.max[k] ? b.max[k] : c.max[k];
      }
    }
    parent[i] = b;
  }
};

// Walks the hierarchy for the body of leaf `leaf`; counts, or with `pair` fills, the pairs it opens. Leaf by leaf:
// neighbours walk through the same nodes, which are still in the cache.
struct PairsOfBody {
  Span<const PlaneRecord> plane;
  Span<const int> world_of;
  Span<const Box> box;
  BoundingBalls balls;
  int grains;
  Span<const int> order;
  Span<const Box> node;
  Span<const int> level_first;
  Span<int> count;
  Span<const int> first;
  Span<Pair> pair;  // empty: count only

  static int constexpr stride = 3;  // levels a walk takes at once

  SCREE_HD void emit(int body, int other, int& n) const {
    if (!pair.empty()) {
      // Insertion keeps the row sorted by the other body: rows are short, and traversal order follows the sort.
      Pair* row = pair.data + first[body];
      int at = n;
      if (other >= 0)
        for (; at > 0 && row[at - 1].b > other; --at) row[at] = row[at - 1];
      row[at] = {body, other};
    }
    ++n;
  }

  SCREE_HD bool balls_meet(int a, int b) const {
    if (balls.radius.empty()) return true;
    double const reach = balls.radius[a] + balls.radius[b];
    return !(norm2(balls.centre[a] - balls.centre[b]) > reach * reach);  // what is no number is the watch's to report
  }

  // Whether a node of the hierarchy covers leaves of the body's world: those lie in ascending order of theirs.
  SCREE_HD bool may_meet(int body, int level, int index) const {
    if (world_of.empty()) return true;
    std::int64_t const begin = std::int64_t{index} << level, end = (std::int64_t{index} + 1) << level;
    int const last = static_cast<int>(end < grains ? end : grains) - 1, mine = world_of[body];
    return world_of[order[static_cast<int>(begin)]] <= mine && mine <= world_of[order[last]];
  }

  SCREE_HD void operator()(int leaf) const {
    int const body = order[leaf];
    Box const mine = box[body];
    if (is_empty(mine)) {  // an inactive body opens no pairs, not with walls either, whose boxes may have no end
      if (pair.empty()) count[body] = 0;
      return;
    }
    int n = 0;
    for (int p = 0; p < plane.size(); ++p) {
      Vec3 const normal = plane[p].normal;
      Vec3 const lowest{normal.x > 0 ? mine.min.x : mine.max.x, normal.y > 0 ? mine.min.y : mine.max.y,
                        normal.z > 0 ? mine.min.z : mine.max.z};
      if (dot(normal, lowest - plane[p].point) <= 0) emit(body, -1 - p, n);
    }
    struct Entry {
      int level, index;
    } stack[80];  // 7 siblings wait at each of 11 levels, the most that 2^31 leaves have with this stride
    int depth = 0;
    stack[depth++] = {level_first.size() - 2, 0};
    while (depth > 0) {
      Entry const e = stack[--depth];
      // Several levels at once: their nodes lie side by side.
      int const step = e.level < stride ? e.level : stride, level = e.level - step, first_child = e.index << step;
      int const width = level_first[level + 1] - level_first[level], last = first_child + (1 << step);
      for (int child = first_child; child < (last < width ? last : width); ++child) {
        if (!overlap(mine, node[level_first[level] + child]) || !may_meet(body, level, child)) continue;
        if (level > 0)
          stack[depth++] = {level, child};
        else if (int const other = order[child]; other > body && balls_meet(body, other))
          emit(body, other, n);
      }
    }
    for (int wall = grains; wall < box.size(); ++wall)
      if (overlap(mine, box[wall])) emit(body, wall, n);
    if (pair.empty()) count[body] = n;
  }
};

// Bits that hold the largest world.
int bits_of_worlds(Span<const int> world_of) {
  int bits = 0;
  for (int const w : world_of)
    while (w >> bits > 0) ++bits;
  return bits;
}

void build_hierarchy(Queue const& queue, Span<const Box> box, Span<const int> world_of, BroadPhase& work) {
  int const n = box.size();
  work.key.resize(n);
  work.order.resize(n);
  Box all = box[0];
  for (Box const& b : box)
    for (int k = 0; k < 3; ++k) {
      all.min[k] = std::min(all.min[k], b.min[k]);
      all.max[k] = std::max(all.max[k], b.max[k]);
    }
  parallel_for(queue, "broad_phase/morton", n,
               MortonKey{box, all, world_of, bits_of_worlds(world_of), work.key, work.order}, 1024);
  sort_by_key(queue, work.key, work.order);
  work.level_first = {0};
  for (int width = n;; width = (width + 1) / 2) {
    work.level_first.push_back(work.level_first.back() + width);
    if (width == 1) break;
  }
  work.node.resize(work.level_first.back());
  Span<Box> const all_nodes = work.node;
  parallel_for(queue, "broad_phase/leaves", n, LeafBox{box, work.order, all_nodes.subspan(0, n)}, 1024);
  for (std::size_t level = 1; level + 1 < work.level_first.size(); ++level) {
    int const below = work.level_first[level - 1], here = work.level_first[level], next = work.level_first[level + 1];
    parallel_for(queue, "broad_phase/levels", next - here,
                 ParentBox{all_nodes.subspan(below, here - below), all_nodes.subspan(here, next - here)}, 1024);
  }
}

}  // namespace

void find_pairs(Queue const& queue, SceneView const& scene, Span<const Box> box, BoundingBalls const& balls,
                BroadPhase& work) {
  int const n = box.size() - scene.walls;
  work.pair.clear();
  if (n == 0) return;
  build_hierarchy(queue, box.subspan(0, n), scene.world_of, work);
  work.count.resize(n);
  work.first.resize(n + 1);
  PairsOfBody functor{scene.plane, scene.world_of,   box,        balls,      n, work.order,
                      work.node,   work.level_first, work.count, work.first, {}};
  parallel_for(queue, "broad_phase/count", n, functor, 64);
  exclusive_scan(queue, work.count, work.first);
  work.pair.resize(work.first[n]);
  functor.pair = work.pair;
  if (!work.pair.empty()) parallel_for(queue, "broad_phase/fill", n, functor, 64);
}

}  // namespace scree
