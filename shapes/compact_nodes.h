// compact_nodes.h: surface nodes into 16-bit radii and back.
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

  void append(DirectionSet const& set);
  void fill(NodesView& view) const;
};

}  // namespace scree
