// node_lists.cpp: rebuilding stale node lists: blocks first, then the nodes of surviving blocks. See node_gather.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "kernels/base/parallel.h"
#include "kernels/base/prefetch.h"
#include "kernels/base/sort_scan.h"
#include "kernels/node_access.h"
#include "kernels/node_gather.h"

namespace scree {
namespace {

// Bounds of a skin in node spacings: below, the list would hold too little to survive round-off of the motion bound;
// above, it holds most of a shape.
double constexpr least_skin = 1.0 / 16, most_skin = 4;

// Makes the matrix of the partner anew: cheaper than to fetch it, for every side at every step.
SCREE_HD RelativePose relative_pose(SceneView const& scene, StateView const& state, Side const& side) {
  Vec3 const c = state.position[side.carrier];
  Quat const q = state.orientation[side.carrier];
  if (side.partner < 0) return {c - scene.plane[-1 - side.partner].point, q};
  Quat const r = state.orientation[side.partner];
  return {transposed_times(to_matrix(r), c - state.position[side.partner]), Quat{r.w, -r.x, -r.y, -r.z} * q};
}

// The body of a side whose motion past the other the list follows: the carrier, but of a wall and a grain the grain. A
// wall's nodes are where they are, and the grain's zero set has moved no further than its ball.
SCREE_HD Side moving_part(SceneView const& scene, Side const& side) {
  return scene.is_wall(side.carrier) ? Side{side.pair, side.partner, side.carrier} : side;
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

struct MarkStale {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  GatherOptions options;
  Span<const Side> side;
  Span<RelativePose> pose;
  Span<const double> margin;
  Span<double> travelled, skin;
  Span<int> stale;

  // Sides stand in the order of their pair's first body; the second one, which has the higher index, is anywhere.
  SCREE_HD void prefetch_side(int s) const {
    int const body = side[s].carrier > side[s].partner ? side[s].carrier : side[s].partner;
    prefetch(state.position, body);
    prefetch(state.orientation, body);
  }

  SCREE_HD void operator()(int s) const {
    if (s + prefetch_ahead < side.size()) prefetch_side(s + prefetch_ahead);
    Side const moving = moving_part(scene, side[s]);
    double const radius = scene.shape_record(moving.carrier).bounding_radius * scene.diameter[moving.carrier];
    RelativePose const now = relative_pose(scene, state, moving);
    travelled[s] += motion_bound(pose[s], now, radius);
    pose[s] = now;
    stale[s] = options.brute_force || margin[s] < 0 || travelled[s] > margin[s];
    if (!stale[s]) return;
    ShapeRecord const& shape = scene.shape_record(side[s].carrier);
    double const d = scene.diameter[side[s].carrier];
    double const wanted = options.skin_steps * options.time_step * motion_rate(state, kinematics, moving, radius);
    double const least = least_skin * shape.node_spacing * d, most = most_skin * shape.node_spacing * d;
    skin[s] = wanted < least ? least : (wanted > most ? most : wanted);
    travelled[s] = 0;
  }
};

// From the carrier's body frame [its d] to the partner's [its unit; planes: z = height]: one product a point. Only for
// rejecting and listing; what is inside is decided at the bits of point_in_partner.
struct ToPartner {
  Mat3 linear;
  Vec3 offset;

  SCREE_HD ToPartner(SceneView const& scene, StateView const& state, KinematicsView const& kinematics,
                     Side const& side) {
    double const d = scene.diameter[side.carrier], unit = partner_unit(scene, side);
    Mat3 const& carrier = kinematics.rotation[side.carrier];
    offset = point_in_partner(scene, state, kinematics, side, {});
    if (side.partner < 0)
      linear = {{{}, {}, transposed_times(carrier, scene.plane[-1 - side.partner].normal)}};
    else
      linear = transpose(kinematics.rotation[side.partner]) * carrier;
    for (Vec3& row : linear.row) row *= d / unit;
  }
  SCREE_HD Vec3 operator()(Vec3 p) const { return offset + linear * p; }
};

// Least distance from y [partner's unit] to the partner's zero set as its ball and its box know it; may be negative.
SCREE_HD double outside_distance(SceneView const& scene, Side const& side, Vec3 y) {
  if (side.partner < 0) return y.z;
  ShapeRecord const& partner = scene.shape_record(side.partner);
  double out2 = 0;
  for (int k = 0; k < 3; ++k) {
    double const low = partner.box.min[k] - y[k], high = y[k] - partner.box.max[k];
    double const out = low > high ? low : high;
    if (out > 0) out2 += out * out;
  }
  double const ball = std::sqrt(norm2(y)) - partner.bounding_radius, box = std::sqrt(out2);
  return ball > box ? ball : box;
}

SCREE_HD void lower(double& least, double value) {
  if (value < least) least = value;
}

double constexpr nothing_left_out = 1e300;

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
  Span<double> gap;
  Span<const int> first;
  Span<int> item, item_side;  // empty: count only
  Span<Vec3> point;
  Span<int> partner;

  SCREE_HD void operator()(int s) const {
    int n = 0;
    double least_gap = nothing_left_out;
    if (stale[s] && !(item.empty() ? whole_side_is_far(s, least_gap) : count[s] == 0)) {
      ShapeRecord const& shape = scene.shape_record(side[s].carrier);
      double const d = scene.diameter[side[s].carrier], unit = partner_unit(scene, side[s]);
      ToPartner const to_partner(scene, state, kinematics, side[s]);
      for (int b = 0; b < shape.blocks; ++b) {
        Vec3 const y = to_partner(block_centre(scene.nodes, shape, b));
        double const apart = outside_distance(scene, side[s], y) * unit - block_radius(scene.nodes, shape, b) * d -
                             scene.cohesion_margin;
        if (!brute_force && apart > skin[s]) {
          lower(least_gap, apart);
          continue;
        }
        if (!item.empty()) {
          int const at = first[s] + n;
          item[at] = b, item_side[at] = s, point[at] = y, partner[at] = side[s].partner;
        }
        ++n;
      }
    }
    if (item.empty()) count[s] = n, gap[s] = least_gap;
  }

  // The carrier's ball against the partner's ball and box, and the other way round.
  SCREE_HD bool whole_side_is_far(int s, double& apart) const {
    if (brute_force) return false;
    Side const& of = side[s];
    double const d = scene.diameter[of.carrier];
    Vec3 const centre = point_in_partner(scene, state, kinematics, of, {});
    double far = outside_distance(scene, of, centre) * partner_unit(scene, of) -
                 scene.shape_record(of.carrier).bounding_radius * d;
    if (of.partner >= 0) {
      Side const reverse{of.pair, of.partner, of.carrier};
      Vec3 const back = point_in_partner(scene, state, kinematics, reverse, {});
      double const other = outside_distance(scene, reverse, back) * d -
                           scene.shape_record(of.partner).bounding_radius * scene.diameter[of.partner];
      if (other > far) far = other;
    }
    far -= scene.cohesion_margin;
    if (!(far > skin[s])) return false;
    apart = far;
    return true;
  }
};

// Nodes of the blocks that one query each did not reject: counts an item's nodes, or lists them with the way the side
// has to travel before each needs a query of its own.
struct CandidateNodes {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  Span<const Side> side;
  Span<const double> skin;
  Span<const int> block_item, block_side;
  Span<const Vec3> block_point;
  Span<const double> block_phi;
  bool brute_force;
  Span<int> count;
  Span<double> gap;
  Span<const int> first;
  Span<int> item;  // empty: count only
  Span<double> way;

  SCREE_HD void operator()(int i) const {
    int const s = block_side[i], b = block_item[i];
    int const carrier = side[s].carrier;
    ShapeRecord const& shape = scene.shape_record(carrier);
    double const unit = partner_unit(scene, side[s]);
    double const radius = block_radius(scene.nodes, shape, b) * scene.diameter[carrier];
    // No point is nearer to the partner than this less its distance from the block's centre.
    double const from_centre = way_to_contact(scene, side[s], block_phi[i]);
    double least_gap = nothing_left_out;
    int n = 0;
    if (!brute_force && from_centre - radius > skin[s]) {
      least_gap = from_centre - radius;
    } else if (item.empty() || count[i] > 0) {
      ToPartner const to_partner(scene, state, kinematics, side[s]);
      NodeRange const range = block_nodes(scene.nodes, shape, b);
      for (int k = range.begin; k < range.end; ++k) {
        Vec3 const y = to_partner(node_position(scene.nodes, shape, k));
        double const by_phi = from_centre - norm(y - block_point[i]) * unit;
        double const by_shape = outside_distance(scene, side[s], y) * unit - scene.cohesion_margin;
        double const apart = by_phi > by_shape ? by_phi : by_shape;
        if (!brute_force && apart > skin[s]) {
          lower(least_gap, apart);
          continue;
        }
        if (!item.empty()) item[first[i] + n] = k, way[first[i] + n] = brute_force || apart <= 0 ? 0 : apart;
        ++n;
      }
    }
    if (item.empty()) count[i] = n, gap[i] = least_gap;
  }
};

// Old list of a fresh side or new list of a stale one: its length, then its nodes and when they are due.
struct NextList {
  Span<const int> stale, old_first, old_node;
  Span<const double> old_due;
  Span<const int> block_first,
      node_first;  // nodes of side s: [node_first[block_first[s]], node_first[block_first[s+1]])
  Span<const int> node_item;
  Span<const double> way;
  Span<int> count;
  Span<const int> next_first;
  Span<int> next_node;  // empty: count only
  Span<double> next_due;

  SCREE_HD void operator()(int s) const {
    int const begin = stale[s] ? node_first[block_first[s]] : old_first[s];
    int const end = stale[s] ? node_first[block_first[s + 1]] : old_first[s + 1];
    if (next_node.empty()) {
      count[s] = end - begin;
      return;
    }
    Span<const int> const from = stale[s] ? node_item : old_node;
    Span<const double> const due = stale[s] ? way : old_due;
    int out = next_first[s];
    for (int i = begin; i < end; ++i, ++out) next_node[out] = from[i], next_due[out] = due[i];
  }
};

// Way a new list covers: the least distance proven for anything left out, at least the skin.
struct NextMargin {
  Span<const int> stale;
  Span<const double> side_gap, block_gap;
  Span<const int> block_first;
  Span<double> margin;

  SCREE_HD void operator()(int s) const {
    if (!stale[s]) return;
    double least = side_gap[s];
    for (int b = block_first[s]; b < block_first[s + 1]; ++b) lower(least, block_gap[b]);
    margin[s] = least;
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
  parallel_for(queue, "node_gather/stale", sides,
               MarkStale{scene, state, kinematics, options, lists.side, lists.pose, lists.margin, lists.travelled,
                         gather.skin, gather.stale},
               256);
  int const stale = static_cast<int>(std::count(gather.stale.begin(), gather.stale.end(), 1));
  if (stale == 0) return;
  lists.rebuilt += stale;

  // Blocks near the partner, and one query each.
  gather.block_first.resize(sides + 1);
  gather.side_gap.resize(sides);
  CandidateBlocks blocks{
      scene,        state,           kinematics,         lists.side, gather.stale, gather.skin, options.brute_force,
      gather.count, gather.side_gap, gather.block_first, {},         {},           {},          {}};
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
  std::vector<Vec3> const block_point = gather.query.point;

  // Nodes of the surviving blocks. They get queries of their own only once they are due.
  gather.count.resize(block_items);
  gather.node_first.resize(block_items + 1);
  gather.block_gap.resize(block_items);
  CandidateNodes nodes{scene,
                       state,
                       kinematics,
                       lists.side,
                       gather.skin,
                       gather.block_item,
                       gather.item_side,
                       gather.query.point,
                       gather.query.phi,
                       options.brute_force,
                       gather.count,
                       gather.block_gap,
                       gather.node_first,
                       {},
                       {}};
  parallel_for(queue, "node_gather/nodes", block_items, nodes, 32);
  exclusive_scan(queue, gather.count, gather.node_first);
  int const node_items = gather.node_first[block_items];
  gather.node_item.resize(node_items);
  gather.node_way.resize(node_items);
  nodes.item = gather.node_item, nodes.way = gather.node_way;
  if (node_items > 0) parallel_for(queue, "node_gather/nodes", block_items, nodes, 32);

  // The next lists: survivors of stale sides, the old list of the others.
  gather.count.resize(sides);
  gather.next_first.resize(sides + 1);
  NextList next{gather.stale,
                lists.first,
                lists.node,
                lists.due,
                gather.block_first,
                gather.node_first,
                gather.node_item,
                gather.node_way,
                gather.count,
                gather.next_first,
                {},
                {}};
  parallel_for(queue, "node_gather/lists", sides, next, 256);
  exclusive_scan(queue, gather.count, gather.next_first);
  gather.next_node.resize(gather.next_first[sides]);
  gather.next_due.resize(gather.next_first[sides]);
  next.next_node = gather.next_node, next.next_due = gather.next_due;
  if (!gather.next_node.empty()) parallel_for(queue, "node_gather/lists", sides, next, 256);
  parallel_for(queue, "node_gather/margins", sides,
               NextMargin{gather.stale, gather.side_gap, gather.block_gap, gather.block_first, lists.margin}, 256);
  std::swap(lists.first, gather.next_first);
  std::swap(lists.node, gather.next_node);
  std::swap(lists.due, gather.next_due);
}

}  // namespace scree
