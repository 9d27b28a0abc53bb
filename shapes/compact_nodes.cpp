// compact_nodes.cpp: see compact_nodes.h and kernels/node_storage.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/compact_nodes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/node_access.h"

namespace scree {
namespace {

// A grain and its directions as kernels see them.
struct OneGrain {
  SharedDirections shared;
  NodesView view;
  ShapeRecord shape;

  OneGrain(CompactGrain const& grain, DirectionSet const& set) {
    shared.place(set);
    shared.fill(view);
    view.compact = {&grain.nodes, 1};
    view.radius = grain.radius;
    view.block_reach = grain.block_reach;
    view.block_ball = grain.block_ball;
    shape.compact = 0;
    shape.nodes = shared.record[0].nodes();
    shape.blocks = shared.record[0].blocks();
  }
};

// Distance of the farthest of the block's nodes from its centre.
double ball_of(OneGrain const& one, int b) {
  Vec3 const centre = block_centre(one.view, one.shape, b);
  NodeRange const range = block_nodes(one.view, one.shape, b);
  double far2 = 0;
  for (int k = range.begin; k < range.end; ++k)
    far2 = std::max(far2, norm2(node_position(one.view, one.shape, k) - centre));
  return std::sqrt(far2);
}

// The distance of the farthest point from a point on the axis is convex along it: halve where it falls.
void choose_balls(DirectionSet const& set, CompactGrain& grain) {
  int const blocks = set.surface_blocks + set.core_blocks;
  grain.block_reach.assign(blocks, 0);
  grain.block_ball.assign(blocks, 0);
  OneGrain const one(grain, set);
  std::vector<double> ball(blocks);
  for (int b = 0; b < blocks; ++b) {
    std::uint8_t& reach = grain.block_reach[b];
    auto const at = [&](int r) {
      reach = static_cast<std::uint8_t>(r);
      return ball_of(one, b);
    };
    int low = 0, high = 255;
    while (low < high) {
      int const middle = (low + high) / 2;
      if (at(middle) <= at(middle + 1))
        high = middle;
      else
        low = middle + 1;
    }
    ball[b] = at(low) * (1 + 1e-12);
  }
  // A hair more than the largest needs, so that rounding up stays within a byte.
  grain.nodes.ball_unit = static_cast<float>(*std::max_element(ball.begin(), ball.end()) / 255 * (1 + 1e-6));
  for (int b = 0; b < blocks; ++b)
    grain.block_ball[b] = static_cast<std::uint8_t>(std::ceil(ball[b] / double(grain.nodes.ball_unit)));
}

}  // namespace

int SharedDirections::place(DirectionSet const& set) {
  for (std::size_t k = 0; k < record.size(); ++k)
    if (record[k].count == set.count()) return static_cast<int>(k);
  DirectionsRecord r;
  r.first = static_cast<int>(direction.size());
  r.count = set.count();
  r.first_ring = static_cast<int>(ring_first.size());
  r.first_neighbour = static_cast<int>(neighbour.size());
  r.first_axis = static_cast<int>(block_axis.size());
  r.surface_blocks = set.surface_blocks;
  r.core_blocks = set.core_blocks;
  record.push_back(r);
  direction.insert(direction.end(), set.direction.begin(), set.direction.end());
  ring_first.insert(ring_first.end(), set.ring_first.begin(), set.ring_first.end());
  neighbour.insert(neighbour.end(), set.neighbour.begin(), set.neighbour.end());
  block_axis.insert(block_axis.end(), set.block_axis.begin(), set.block_axis.end());
  return static_cast<int>(record.size()) - 1;
}

void SharedDirections::fill(NodesView& view) const {
  view.directions = record;
  view.direction = direction;
  view.block_axis = block_axis;
  view.ring_first = ring_first;
  view.neighbour = neighbour;
}

void CompactStore::reserve(std::size_t grains, DirectionSet const& set) {
  std::size_t const blocks = std::size_t(set.surface_blocks) + set.core_blocks;
  record.reserve(record.size() + grains);
  radius.reserve(radius.size() + grains * set.count());
  block_reach.reserve(block_reach.size() + grains * blocks);
  block_ball.reserve(block_ball.size() + grains * blocks);
}

void CompactStore::append(CompactGrain const& grain, int set, ShapeRecord& shape) {
  shape.compact = static_cast<int>(record.size());
  shape.first_node = static_cast<int>(radius.size());
  shape.first_block = static_cast<int>(block_ball.size());
  shape.nodes = directions.record[set].nodes();
  shape.blocks = directions.record[set].blocks();
  shape.node_spacing = std::sqrt(double(grain.nodes.area) / directions.record[set].count);
  record.push_back(grain.nodes);
  record.back().directions = set;
  radius.insert(radius.end(), grain.radius.begin(), grain.radius.end());
  block_reach.insert(block_reach.end(), grain.block_reach.begin(), grain.block_reach.end());
  block_ball.insert(block_ball.end(), grain.block_ball.begin(), grain.block_ball.end());
}

void CompactStore::fill(NodesView& view) const {
  directions.fill(view);
  view.compact = record;
  view.radius = radius;
  view.block_reach = block_reach;
  view.block_ball = block_ball;
}

void encode_nodes(Rays const& rays, DirectionSet const& set, std::vector<double> const& radius, CompactGrain& grain) {
  auto const [least, most] = std::minmax_element(radius.begin(), radius.end());
  CompactRecord& c = grain.nodes;
  c = {};
  c.low = static_cast<float>(*least);
  c.step = static_cast<float>((*most - *least) / 65535);
  c.centre = to_float(rays.origin);
  for (int i = 0; i < 3; ++i) c.frame[i] = to_float(rays.map.row[i]);
  grain.radius.resize(radius.size());
  for (std::size_t i = 0; i < radius.size(); ++i) {
    double const q = c.step > 0 ? (radius[i] - double(c.low)) / double(c.step) : 0;
    grain.radius[i] = static_cast<std::uint16_t>(std::clamp(std::round(q), 0.0, 65535.0));
  }
  OneGrain const one(grain, set);
  double flux = 0, area = 0;
  for (int k = 0; k < set.count(); ++k) {
    Vec3 const a = compact_area_vector(one.view, one.shape, k);
    flux += dot(a, node_position(one.view, one.shape, k));
    area += norm(a);
  }
  c.area_scale = static_cast<float>(std::numbers::pi / 2 / flux);  // 3 V over that of the inscribed polyhedron
  c.area = static_cast<float>(area * double(c.area_scale));
  choose_balls(set, grain);
}

SurfaceNodes explicit_nodes(CompactGrain const& grain, DirectionSet const& set) {
  OneGrain const one(grain, set);
  SurfaceNodes nodes;
  nodes.n_surface = set.count();
  nodes.spacing = std::sqrt(double(grain.nodes.area) / set.count());
  for (int k = 0; k < one.shape.nodes; ++k) {
    nodes.position.push_back(node_position(one.view, one.shape, k));
    nodes.area.push_back(node_area(one.view, one.shape, k));
    nodes.normal.push_back(k < set.count() ? normalized(compact_area_vector(one.view, one.shape, k)) : Vec3{});
  }
  nodes.block_first.push_back(0);
  for (int b = 0; b < one.shape.blocks; ++b) {
    nodes.block_centre.push_back(block_centre(one.view, one.shape, b));
    nodes.block_radius.push_back(block_radius(one.view, one.shape, b));
    nodes.block_first.push_back(block_nodes(one.view, one.shape, b).end);
  }
  return nodes;
}

}  // namespace scree
