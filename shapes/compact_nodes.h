// compact_nodes.h: surface nodes into 16-bit radii and back.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/views.h"
#include "shapes/compact_grain.h"

namespace scree {

// Fills in grain.nodes, radius and blocks from the rays of a normalised body (units of d, volume pi/6). A radius errs
// by half a step, 1/131,070 of their range; a block's ball is rounded up, so it never loses a node.
void encode_nodes(Rays const& rays, DirectionSet const& set, std::vector<double> const& radius, CompactGrain& grain);

// The arrays of direction sets as kernels take them.
struct SharedDirections {
  std::vector<DirectionsRecord> record;
  std::vector<Vec3> direction, block_axis;
  std::vector<int> ring_first, neighbour;

  // Index of the set of this count, appended where it is new: make_direction_set makes one a count.
  int place(DirectionSet const& set);
  void fill(NodesView& view) const;
};

// Nodes of all compact shapes of a scene.
struct CompactStore {
  SharedDirections directions;
  std::vector<CompactRecord> record;                  // (n_compact_shapes)
  std::vector<std::uint16_t> radius;                  // (n_compact_nodes)
  std::vector<std::uint8_t> block_reach, block_ball;  // (n_compact_blocks)

  // Room for so many more grains of this set: vectors that grow by doubling hold up to twice what they need.
  void reserve(std::size_t grains, DirectionSet const& set);
  // `set`: index of the grain's directions in directions.record. Fills in the node fields of `shape`.
  void append(CompactGrain const& grain, int set, ShapeRecord& shape);
  void fill(NodesView& view) const;
};

}  // namespace scree
