// node_access.h: position, area and block of a surface node, however it is stored.
// The one place where kernels read nodes, so that both storages give every stage the same bits.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/views.h"

namespace scree {

struct NodeRange {
  int begin, end;  // relative to the shape's first node
};

namespace detail {

SCREE_HD inline Vec3 apply_frame(Vec3f const (&frame)[3], Vec3 v) {
  return {dot(to_double(frame[0]), v), dot(to_double(frame[1]), v), dot(to_double(frame[2]), v)};
}
SCREE_HD inline Vec3 frame_cofactor(Vec3f const (&frame)[3], Vec3 v) {  // (F a) x (F b) = cofactor (a x b)
  Vec3 const x = to_double(frame[0]), y = to_double(frame[1]), z = to_double(frame[2]);
  return {dot(cross(y, z), v), dot(cross(z, x), v), dot(cross(x, y), v)};
}
SCREE_HD inline Vec3 ray_point(NodesView const& nodes, ShapeRecord const& shape, CompactRecord const& c,
                               DirectionsRecord const& set, int k) {
  double const r = double(c.low) + double(c.step) * nodes.radius[shape.first_node + k];
  return nodes.direction[set.first + k] * r;
}

}  // namespace detail

// Integral of the outward normal over the cell of surface node k [d^2], compact shapes: a third of the area vectors of
// the triangles around the node. Those of all nodes close exactly. The node's own radius drops out of the sum.
SCREE_HD inline Vec3 compact_area_vector(NodesView const& nodes, ShapeRecord const& shape, int k) {
  CompactRecord const& c = nodes.compact[shape.compact];
  DirectionsRecord const& set = nodes.directions[c.directions];
  int const begin = set.first_neighbour + nodes.ring_first[set.first_ring + k];
  int const end = set.first_neighbour + nodes.ring_first[set.first_ring + k + 1];
  Vec3 sum, before = detail::ray_point(nodes, shape, c, set, nodes.neighbour[end - 1]);
  for (int i = begin; i < end; ++i) {
    Vec3 const at = detail::ray_point(nodes, shape, c, set, nodes.neighbour[i]);
    sum += cross(before, at);
    before = at;
  }
  return detail::frame_cofactor(c.frame, sum * (double(c.area_scale) / 6));
}

SCREE_HD inline Vec3 node_position(NodesView const& nodes, ShapeRecord const& shape, int k) {
  if (shape.compact < 0) return nodes.position[shape.first_node + k];
  CompactRecord const& c = nodes.compact[shape.compact];
  DirectionsRecord const& set = nodes.directions[c.directions];
  bool const surface = k < set.count;
  int const of = surface ? k : (k - set.count) * core_every;
  if (of >= set.count) return {};
  Vec3 const x = to_double(c.centre) + detail::apply_frame(c.frame, detail::ray_point(nodes, shape, c, set, of));
  return surface ? x : x * core_scale;
}

SCREE_HD inline double node_area(NodesView const& nodes, ShapeRecord const& shape, int k) {
  if (shape.compact < 0) return nodes.area[shape.first_node + k];
  CompactRecord const& c = nodes.compact[shape.compact];
  DirectionsRecord const& set = nodes.directions[c.directions];
  if (k < set.count) return norm(compact_area_vector(nodes, shape, k));
  int const of = (k - set.count) * core_every;
  return of < set.count ? norm(compact_area_vector(nodes, shape, of)) * core_every : double(c.area);
}

// Ball around the nodes of block b.
SCREE_HD inline Vec3 block_centre(NodesView const& nodes, ShapeRecord const& shape, int b) {
  if (shape.compact < 0) return nodes.block_centre[shape.first_block + b];
  CompactRecord const& c = nodes.compact[shape.compact];
  DirectionsRecord const& set = nodes.directions[c.directions];
  if (b == set.surface_blocks + set.core_blocks) return {};
  double const reach = double(c.low) + 257.0 * double(c.step) * nodes.block_reach[shape.first_block + b];
  Vec3 const x = to_double(c.centre) + detail::apply_frame(c.frame, nodes.block_axis[set.first_axis + b] * reach);
  return b < set.surface_blocks ? x : x * core_scale;
}
SCREE_HD inline double block_radius(NodesView const& nodes, ShapeRecord const& shape, int b) {
  if (shape.compact < 0) return nodes.block_radius[shape.first_block + b];
  CompactRecord const& c = nodes.compact[shape.compact];
  if (b + 1 == shape.blocks) return 0;
  return double(c.ball_unit) * nodes.block_ball[shape.first_block + b];
}
SCREE_HD inline NodeRange block_nodes(NodesView const& nodes, ShapeRecord const& shape, int b) {
  if (shape.compact < 0)
    return {nodes.block_first[shape.first_bound + b], nodes.block_first[shape.first_bound + b + 1]};
  DirectionsRecord const& set = nodes.directions[nodes.compact[shape.compact].directions];
  bool const surface = b < set.surface_blocks;
  int const begin = surface ? b * nodes_per_block : set.count + (b - set.surface_blocks) * nodes_per_block;
  int const core_end = set.count + set.core_nodes();
  if (b + 1 == shape.blocks) return {core_end, core_end + 1};
  int const limit = surface ? set.count : core_end;
  return {begin, begin + nodes_per_block < limit ? begin + nodes_per_block : limit};
}

}  // namespace scree
