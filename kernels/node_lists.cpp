// node_lists.cpp: rebuilding stale node lists: blocks first, then the nodes of surviving blocks. See node_gather.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "kernels/base/parallel.h"
#include "kernels/base/sort_scan.h"
#include "kernels/node_gather.h"

namespace scree {
namespace {

// A rebuild costs about 600 queries, each step between rebuilds the listed nodes: the sum is flat around this many
// steps of motion a skin.
double constexpr steps_a_skin = 12;
// Bounds of a skin in node spacings: below, the list would hold too little to survive round-off of the motion bound;
// above, it holds most of a shape.
double constexpr least_skin = 1.0 / 16, most_skin = 4;

SCREE_HD RelativePose relative_pose(SceneView const& scene, StateView const& state, KinematicsView const& kinematics,
                                    Side const& side) {
  Vec3 const c = state.position[side.carrier];
  Quat const q = state.orientation[side.carrier];
  if (side.partner < 0) return {c - scene.plane[-1 - side.partner].point, q};
  Quat const r = state.orientation[side.partner];
  return {transposed_times(kinematics.rotation[side.partner], c - state.position[side.partner]),
          Quat{r.w, -r.x, -r.y, -r.z} * q};
}

// How far any point within `radius` of the carrier's centroid has moved in the partner's frame since `from` [m].
SCREE_HD double motion_bound(RelativePose const& from, RelativePose const& to, double radius) {
  Quat const f = from.orientation;
  Quat const turn = Quat{f.w, -f.x, -f.y, -f.z} * to.orientation;
  double const half_chord = std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);  // sin(angle / 2)
  // 1e-12: round-off of the poses, far below any skin.
  return norm(to.position - from.position) + 2 * radius * half_chord + 1e-12;
}

// Bound on the speed of the carrier's points in the partner's frame [m/s].
SCREE_HD double motion_rate(StateView const& state, KinematicsView const& kinematics, Side const& side, double radius) {
  Vec3 v = state.velocity[side.carrier];
  Vec3 w = kinematics.spin[side.carrier];
  if (side.partner >= 0) {
    Vec3 const arm = state.position[side.carrier] - state.position[side.partner];
    v = v - state.velocity[side.partner] - cross(kinematics.spin[side.partner], arm);
    w = w - kinematics.spin[side.partner];
  }
  return norm(v) + radius * norm(w);
}

SCREE_HD double partner_unit(SceneView const& scene, Side const& side) {
  return side.partner < 0 ? 1 : scene.diameter[side.partner];
}

struct MarkStale {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  GatherOptions options;
  Span<const Side> side;
  Span<RelativePose> built;
  Span<double> margin, skin;
  Span<int> stale;

  SCREE_HD void operator()(int s) const {
    ShapeRecord const& shape = scene.shape_record(side[s].carrier);
    double const d = scene.diameter[side[s].carrier], radius = shape.bounding_radius * d;
    RelativePose const now = relative_pose(scene, state, kinematics, side[s]);
    stale[s] = options.brute_force || margin[s] < 0 || motion_bound(built[s], now, radius) > margin[s];
    if (!stale[s]) return;
    double const wanted = steps_a_skin * options.time_step * motion_rate(state, kinematics, side[s], radius);
    double const least = least_skin * shape.node_spacing * d, most = most_skin * shape.node_spacing * d;
    skin[s] = wanted < least ? least : (wanted > most ? most : wanted);
    built[s] = now;
    margin[s] = skin[s];
  }
};

// Could a ball of radius `reach` [partner's unit] around y touch the partner's zero set?
SCREE_HD bool may_touch(ShapeRecord const& partner, Vec3 y, double reach) {
  double const ball = partner.bounding_radius + reach;
  if (norm2(y) > ball * ball) return false;
  double out2 = 0;
  for (int k = 0; k < 3; ++k) {
    double const low = partner.box.min[k] - y[k], high = y[k] - partner.box.max[k];
    double const out = low > high ? low : high;
    if (out > 0) out2 += out * out;
  }
  return out2 <= reach * reach;
}

// Blocks of a stale side that survive the partner's ball and box: counts, or fills items when `item` is given.
struct CandidateBlocks {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  Span<const Side> side;
  Span<const int> stale;
  Span<const double> skin;
  bool brute_force;
  Span<int> count;
  Span<const int> first;
  Span<int> item, item_side;  // empty: count only
  Span<Vec3> point;
  Span<int> partner;

  SCREE_HD void operator()(int s) const {
    int n = 0;
    if (stale[s]) {
      ShapeRecord const& shape = scene.shape_record(side[s].carrier);
      double const d = scene.diameter[side[s].carrier], unit = partner_unit(scene, side[s]);
      for (int b = 0; b < shape.blocks; ++b) {
        Vec3 const y =
            point_in_partner(scene, state, kinematics, side[s], scene.nodes.block_centre[shape.first_block + b]);
        double const reach = (scene.nodes.block_radius[shape.first_block + b] * d + skin[s]) / unit;
        bool const near = side[s].partner < 0 ? y.z <= reach : may_touch(scene.shape_record(side[s].partner), y, reach);
        if (!brute_force && !near) continue;
        if (!item.empty()) {
          int const at = first[s] + n;
          item[at] = b, item_side[at] = s, point[at] = y, partner[at] = side[s].partner;
        }
        ++n;
      }
    }
    if (item.empty()) count[s] = n;
  }
};

// Nodes of the blocks that one query each did not reject: counts an item's nodes, or fills them.
struct CandidateNodes {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  Span<const Side> side;
  Span<const double> skin;
  Span<const int> block_item, block_side;
  Span<const double> block_phi;
  bool brute_force;
  Span<int> count;
  Span<const int> first;
  Span<int> item, item_side;  // empty: count only
  Span<Vec3> point;
  Span<int> partner;

  SCREE_HD void operator()(int i) const {
    int const s = block_side[i], b = block_item[i];
    int const carrier = side[s].carrier, shape_index = scene.shape_of[carrier];
    ShapeRecord const& shape = scene.shape[shape_index];
    double const d = scene.diameter[carrier], unit = partner_unit(scene, side[s]);
    double const lipschitz = side[s].partner < 0 ? 1 : scene.shape_record(side[s].partner).lipschitz;
    double const radius = scene.nodes.block_radius[shape.first_block + b] * d;
    int n = 0;
    if (brute_force || block_phi[i] >= -(radius + skin[s]) / unit * lipschitz) {
      Span<const int> const bounds = scene.nodes.block_first;
      int const entry = shape.first_block + shape_index + b;
      for (int k = bounds[entry]; k < bounds[entry + 1]; ++k) {
        Vec3 const y = point_in_partner(scene, state, kinematics, side[s], scene.nodes.position[shape.first_node + k]);
        double const reach = skin[s] / unit;
        bool const near = side[s].partner < 0 ? y.z <= reach : may_touch(scene.shape_record(side[s].partner), y, reach);
        if (!brute_force && !near) continue;
        if (!item.empty()) {
          int const at = first[i] + n;
          item[at] = k, item_side[at] = s, point[at] = y, partner[at] = side[s].partner;
        }
        ++n;
      }
    }
    if (item.empty()) count[i] = n;
  }
};

struct KeepNode {
  SceneView scene;
  Span<const Side> side;
  Span<const double> skin;
  Span<const int> item_side;
  Span<const double> phi;
  bool brute_force;
  Span<int> keep;

  SCREE_HD void operator()(int i) const {
    Side const& of = side[item_side[i]];
    double const lipschitz = of.partner < 0 ? 1 : scene.shape_record(of.partner).lipschitz;
    keep[i] = brute_force || phi[i] > -skin[item_side[i]] / partner_unit(scene, of) * lipschitz;
  }
};

// Old list of a fresh side or new list of a stale one: its length, then its nodes.
struct NextList {
  Span<const int> stale, old_first, old_node;
  Span<const int> block_first,
      node_first;  // nodes of side s: [node_first[block_first[s]], node_first[block_first[s+1]])
  Span<const int> node_item, kept_before;
  Span<int> count;
  Span<const int> next_first;
  Span<int> next_node;  // empty: count only

  SCREE_HD void operator()(int s) const {
    if (!stale[s]) {
      int const n = old_first[s + 1] - old_first[s];
      if (next_node.empty())
        count[s] = n;
      else
        for (int i = 0; i < n; ++i) next_node[next_first[s] + i] = old_node[old_first[s] + i];
      return;
    }
    int const begin = node_first[block_first[s]], end = node_first[block_first[s + 1]];
    if (next_node.empty()) {
      count[s] = kept_before[end] - kept_before[begin];
      return;
    }
    int out = next_first[s];
    for (int i = begin; i < end; ++i)
      if (kept_before[i + 1] > kept_before[i]) next_node[out++] = node_item[i];
  }
};

void groups(std::vector<int> const& side_group, Span<const int> first, std::vector<int>& group) {
  group.resize(side_group.size());
  for (std::size_t g = 0; g < side_group.size(); ++g) group[g] = first[side_group[g]];
}

}  // namespace

void update_node_lists(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                       NetworkSet const& networks, GatherOptions const& options, NodeGather& gather) {
  NodeLists& lists = gather.lists;
  int const sides = static_cast<int>(lists.side.size());
  if (sides == 0) return;
  for (auto* v : {&gather.stale, &gather.count}) v->resize(sides);
  gather.skin.resize(sides);
  parallel_for(
      queue, "node_gather/stale", sides,
      MarkStale{scene, state, kinematics, options, lists.side, lists.built, lists.margin, gather.skin, gather.stale},
      256);
  int const stale = static_cast<int>(std::count(gather.stale.begin(), gather.stale.end(), 1));
  if (stale == 0) return;
  lists.rebuilt += stale;

  // Blocks near the partner, and one query each.
  gather.block_first.resize(sides + 1);
  CandidateBlocks blocks{scene,
                         state,
                         kinematics,
                         lists.side,
                         gather.stale,
                         gather.skin,
                         options.brute_force,
                         gather.count,
                         gather.block_first,
                         {},
                         {},
                         {},
                         {}};
  parallel_for(queue, "node_gather/blocks", sides, blocks, 16);
  exclusive_scan(queue, gather.count, gather.block_first);
  int const block_items = gather.block_first[sides];
  gather.block_item.resize(block_items);
  gather.item_side.resize(block_items);
  gather.query.resize(block_items);
  groups(lists.group, gather.block_first, gather.query.group);
  blocks.item = gather.block_item, blocks.item_side = gather.item_side;
  blocks.point = gather.query.point, blocks.partner = gather.query.partner;
  if (block_items > 0) parallel_for(queue, "node_gather/blocks", sides, blocks, 16);
  evaluate_phi(queue, scene, networks, gather.query);
  lists.block_queries += block_items;
  std::vector<double> const block_phi = gather.query.phi;

  // Nodes of the surviving blocks, and one query each.
  gather.count.resize(block_items);
  gather.node_first.resize(block_items + 1);
  CandidateNodes nodes{scene,
                       state,
                       kinematics,
                       lists.side,
                       gather.skin,
                       gather.block_item,
                       gather.item_side,
                       block_phi,
                       options.brute_force,
                       gather.count,
                       gather.node_first,
                       {},
                       {},
                       {},
                       {}};
  parallel_for(queue, "node_gather/nodes", block_items, nodes, 32);
  exclusive_scan(queue, gather.count, gather.node_first);
  int const node_items = gather.node_first[block_items];
  gather.node_item.resize(node_items);
  gather.node_side.resize(node_items);
  gather.query.resize(node_items);
  std::vector<int> group;
  groups(lists.group, gather.block_first, group);
  groups(group, gather.node_first, gather.query.group);
  nodes.item = gather.node_item, nodes.item_side = gather.node_side;
  nodes.point = gather.query.point, nodes.partner = gather.query.partner;
  if (node_items > 0) parallel_for(queue, "node_gather/nodes", block_items, nodes, 32);
  evaluate_phi(queue, scene, networks, gather.query);
  lists.node_queries += node_items;

  // The next lists: survivors of stale sides, the old list of the others.
  gather.keep.resize(node_items);
  gather.kept_first.resize(node_items + 1);
  parallel_for(
      queue, "node_gather/keep", node_items,
      KeepNode{scene, lists.side, gather.skin, gather.node_side, gather.query.phi, options.brute_force, gather.keep},
      1024);
  exclusive_scan(queue, gather.keep, gather.kept_first);
  gather.count.resize(sides);
  gather.next_first.resize(sides + 1);
  NextList next{gather.stale,     lists.first,       lists.node,   gather.block_first, gather.node_first,
                gather.node_item, gather.kept_first, gather.count, gather.next_first,  {}};
  parallel_for(queue, "node_gather/lists", sides, next, 256);
  exclusive_scan(queue, gather.count, gather.next_first);
  gather.next_node.resize(gather.next_first[sides]);
  next.next_node = gather.next_node;
  if (!gather.next_node.empty()) parallel_for(queue, "node_gather/lists", sides, next, 256);
  std::swap(lists.first, gather.next_first);
  std::swap(lists.node, gather.next_node);
}

}  // namespace scree
