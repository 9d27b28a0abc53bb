// node_storage.h: how surface nodes are kept: as arrays, or as 16-bit radii along directions that many shapes share.
// Units of the shape's d, body frame. Kernels reach nodes through node_access.h only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"

namespace scree {

int constexpr nodes_per_block = 32;  // one network query decides over a block; 32 = 11-12 % of nodes survive it
int constexpr core_every = 4;        // one surface node in so many is repeated inside
double constexpr core_scale = 0.5;   // at this share of its position, with core_every times its area

// Unit directions shared by every compact shape of this node count, in blocks of nodes_per_block, and the triangulation
// that joins neighbours. Indices into the arrays of NodesView.
struct DirectionsRecord {
  int first = 0, count = 0;                 // direction
  int first_ring = 0;                       // ring_first, count + 1 entries
  int first_neighbour = 0;                  // neighbour; ring_first counts from here
  int first_axis = 0;                       // block_axis: of surface blocks, then of core blocks
  int surface_blocks = 0, core_blocks = 0;  // the centre is a block of its own after them
  SCREE_HD int core_nodes() const { return (count + core_every - 1) / core_every; }
  SCREE_HD int nodes() const { return count + core_nodes() + 1; }
  SCREE_HD int blocks() const { return surface_blocks + core_blocks + 1; }
};

// Nodes of one compact shape: node k at centre + frame (direction_k (low + step q_k)), q_k the 16 bits that are kept.
// `frame` maps the unit ball to an ellipsoid like the shape: nodes are dense on its tips. Core nodes and the centre
// (see SurfaceNodes) follow from the surface nodes and are not kept. A block's ball has its centre at
// centre + frame (axis (low + 257 step reach)) and the radius ball_unit * ball, two bytes.
struct CompactRecord {
  int directions = 0;  // index of the set
  float low = 0, step = 0;
  float ball_unit = 0;   // [d]
  float area_scale = 1;  // makes sum A x.n = 3 V exact
  float area = 0;        // sum of the areas of surface nodes [d^2]
  Vec3f centre;          // where the rays start [d]
  Vec3f frame[3];        // rows [d]
};

struct NodesView {
  // Nodes as arrays.
  Span<const Vec3> position;        // [d], of all shapes (n_nodes)
  Span<const double> area;          // [d^2] (n_nodes)
  Span<const Vec3> block_centre;    // [d] (n_blocks)
  Span<const double> block_radius;  // [d] (n_blocks)
  Span<const int> block_first;      // first node of a block, relative to the shape's first node (n_blocks + shapes):
                                    // block b of a shape at first_bound + b, with an end entry a shape
  // Compact nodes.
  Span<const CompactRecord> compact;                 // (n_compact_shapes)
  Span<const std::uint16_t> radius;                  // q (n_compact_nodes)
  Span<const std::uint8_t> block_reach, block_ball;  // of all blocks but the centres'
  Span<const DirectionsRecord> directions;
  Span<const Vec3> direction, block_axis;
  Span<const int> ring_first, neighbour;  // neighbours of a node, counter-clockwise seen from outside
};

}  // namespace scree
