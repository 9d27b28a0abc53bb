// node_gather.cpp: sides of pairs, and the nodes inside at this step. The lists themselves: node_lists.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/node_gather.h"

#include <algorithm>
#include <numeric>

#include "kernels/base/parallel.h"
#include "kernels/base/sort_scan.h"
#include "kernels/node_access.h"

namespace scree {
namespace {

struct KinematicsOfBody {
  SceneView scene;
  StateView state;
  Span<Mat3> rotation;
  Span<Vec3> spin;

  SCREE_HD void operator()(int i) const {
    rotation[i] = to_matrix(state.orientation[i]);
    spin[i] = scene.is_wall(i) ? state.angular_momentum[i]
                               : spin_of(rotation[i], scene.inertia[i], state.angular_momentum[i]);
  }
};

// Listed nodes that are due: counts them, or fills their points.
struct DueNodes {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  Span<const Side> side;
  Span<const double> travelled;
  Span<const int> first, node;
  Span<const double> due;
  Span<int> count;
  Span<const int> due_first;
  Span<int> entry;  // of the list; empty: count only
  Span<Vec3> point;
  Span<int> partner;
  Span<char> graded;

  SCREE_HD void operator()(int s) const {
    ShapeRecord const& shape = scene.shape_record(side[s].carrier);
    int n = 0;
    for (int i = first[s]; i < first[s + 1]; ++i) {
      if (due[i] > travelled[s]) continue;
      if (!entry.empty()) {
        int const at = due_first[s] + n;
        entry[at] = i;
        Vec3 const p = node_position(scene.nodes, shape, node[i]);
        point[at] = point_in_partner(scene, state, kinematics, side[s], p);
        partner[at] = side[s].partner;
        graded[at] = due[i] == was_inside;
      }
      ++n;
    }
    if (entry.empty()) count[s] = n;
  }
};

// Counts the nodes inside, and those of them without a gradient yet, and puts the others off until they can be.
struct NextDue {
  SceneView scene;
  Span<const Side> side;
  Span<const double> travelled;
  bool brute_force;
  Span<const int> due_first, entry;
  Span<const double> phi;
  Span<const char> graded;
  Span<double> due;
  Span<int> count, again_count;

  SCREE_HD void operator()(int s) const {
    int n = 0, again = 0;
    double const outside = -adhesive_reach(scene, side[s]) / partner_unit(scene, side[s]);
    for (int i = due_first[s]; i < due_first[s + 1]; ++i) {
      bool const inside = phi[i] > outside;
      n += inside;
      again += inside && !graded[i];
      double const way = way_to_contact(scene, side[s], phi[i]);
      double const next = way <= 0 ? 0 : travelled[s] + way;
      due[entry[i]] = brute_force ? 0 : inside ? was_inside : next;
    }
    count[s] = n;
    again_count[s] = again;
  }
};

struct FillActive {
  SceneView scene;
  Span<const Side> side;
  Span<const int> due_first, entry, listed_node;
  Span<const double> phi;
  Span<const Vec3> gradient;
  Span<const char> graded;
  Span<const Vec3> due_point;
  Span<const int> due_partner;
  Span<const int> first;
  Span<int> node;
  Span<Vec3> point;
  Span<int> partner;
  Span<double> active_phi;
  Span<Vec3> active_gradient;
  Span<const int> again_first;
  Span<int> again_at;  // of the active nodes
  Span<Vec3> again_point;
  Span<int> again_partner;

  SCREE_HD void operator()(int s) const {
    int out = first[s], again = again_first[s];
    double const outside = -adhesive_reach(scene, side[s]) / partner_unit(scene, side[s]);
    for (int i = due_first[s]; i < due_first[s + 1]; ++i) {
      if (!(phi[i] > outside)) continue;
      node[out] = listed_node[entry[i]];
      point[out] = due_point[i];
      partner[out] = due_partner[i];
      active_phi[out] = phi[i];
      if (graded[i]) {
        active_gradient[out] = gradient[i];
      } else {
        again_at[again] = out;
        again_point[again] = due_point[i];
        again_partner[again++] = due_partner[i];
      }
      ++out;
    }
  }
};

struct CopyGradients {
  Span<const int> at;
  Span<const Vec3> from;
  Span<Vec3> to;

  SCREE_HD void operator()(int i) const { to[at[i]] = from[i]; }
};

void groups_of_items(std::vector<int> const& side_group, std::vector<int> const& first, std::vector<int>& group) {
  group.resize(side_group.size());
  for (std::size_t g = 0; g < side_group.size(); ++g) group[g] = first[side_group[g]];
}

int group_of(SceneView const& scene, Side const& side, int networks) {
  if (side.partner < 0) return query_group(SdfKind::analytic, -1, networks);
  ShapeRecord const& partner = scene.shape_record(side.partner);
  return query_group(partner.sdf, partner.net, networks);
}

}  // namespace

void compute_kinematics(Queue const& queue, SceneView const& scene, StateView const& state, Kinematics& kinematics) {
  kinematics.rotation.resize(scene.solids());
  kinematics.spin.resize(scene.solids());
  parallel_for(queue, "integrate/kinematics", scene.solids(),
               KinematicsOfBody{scene, state, kinematics.rotation, kinematics.spin}, 512);
}

void assign_sides(SceneView const& scene, int networks, Span<const Pair> pair, Span<const int> old_pair,
                  Span<const char> closed_form, NodeGather& gather, std::vector<int>& old_side) {
  NodeLists old = std::move(gather.lists);
  NodeLists& lists = gather.lists;
  lists = {};
  lists.rebuilt = old.rebuilt, lists.block_queries = old.block_queries;
  for (int k = 0; k < pair.size(); ++k) {
    if (closed_form[k]) continue;
    Pair const p = pair[k];
    if (scene.shape_record(p.a).nodes > 0) lists.side.push_back({k, p.a, p.b});
    if (!p.with_plane() && scene.shape_record(p.b).nodes > 0) lists.side.push_back({k, p.b, p.a});
  }
  std::stable_sort(lists.side.begin(), lists.side.end(), [&](Side const& x, Side const& y) {
    return group_of(scene, x, networks) < group_of(scene, y, networks);
  });
  int const n = static_cast<int>(lists.side.size());
  lists.group.assign(query_groups(networks) + 1, 0);
  for (Side const& s : lists.side) {
    ++lists.group[group_of(scene, s, networks) + 1];
    lists.nodes += scene.shape_record(s.carrier).nodes;
  }
  std::partial_sum(lists.group.begin(), lists.group.end(), lists.group.begin());
  lists.side_of_pair.assign(2 * std::size_t(pair.size()), -1);
  lists.pose.resize(n);
  lists.travelled.assign(n, 0);
  lists.margin.assign(n, -1);
  lists.first.assign(1, 0);
  old_side.assign(n, -1);
  for (int s = 0; s < n; ++s) {
    Side const& side = lists.side[s];
    int const which = side.carrier == pair[side.pair].a ? 0 : 1;
    lists.side_of_pair[2 * std::size_t(side.pair) + which] = s;
    int const before = old_pair[side.pair] < 0 ? -1 : old.side_of_pair[2 * std::size_t(old_pair[side.pair]) + which];
    old_side[s] = before;
    if (before >= 0) {
      lists.pose[s] = old.pose[before];
      lists.travelled[s] = old.travelled[before];
      lists.margin[s] = old.margin[before];
      int const begin = old.first[before], end = old.first[before + 1];
      lists.node.insert(lists.node.end(), old.node.begin() + begin, old.node.begin() + end);
      lists.due.insert(lists.due.end(), old.due.begin() + begin, old.due.begin() + end);
    }
    lists.first.push_back(static_cast<int>(lists.node.size()));
  }
}

void find_active_nodes(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                       NetworkSet const& networks, GatherOptions const& options, NodeLists& lists,
                       ActiveNodes& active) {
  int const sides = static_cast<int>(lists.side.size());
  for (auto* v : {&active.count, &active.again_count}) v->resize(sides);
  for (auto* v : {&active.due_first, &active.first, &active.again_first}) v->resize(sides + 1);
  DueNodes due{scene,
               state,
               kinematics,
               lists.side,
               lists.travelled,
               lists.first,
               lists.node,
               lists.due,
               active.count,
               active.due_first,
               {},
               {},
               {},
               {}};
  parallel_for(queue, "node_gather/due", sides, due, 512);
  exclusive_scan(queue, active.count, active.due_first);
  int const n_due = active.due_first[sides];
  active.due.resize(n_due);
  active.due_entry.resize(n_due);
  active.graded.resize(n_due);
  groups_of_items(lists.group, active.due_first, active.due.group);
  due.entry = active.due_entry, due.point = active.due.point, due.partner = active.due.partner;
  due.graded = active.graded;
  if (n_due > 0) parallel_for(queue, "node_gather/due", sides, due, 64);
  // A hair below the reach, since what is active is decided in units of the partner.
  double const gradient_from = -scene.cohesion_reach * (1 + 1e-12);
  evaluate_phi_and_marked_gradients(queue, scene, networks, active.due, active.graded, gradient_from);
  active.nodes += lists.nodes;
  active.listed += static_cast<std::int64_t>(lists.node.size());
  active.queries += n_due;
  parallel_for(queue, "node_gather/next_due", sides,
               NextDue{scene, lists.side, lists.travelled, options.brute_force, active.due_first, active.due_entry,
                       active.due.phi, active.graded, lists.due, active.count, active.again_count},
               512);
  exclusive_scan(queue, active.count, active.first);
  exclusive_scan(queue, active.again_count, active.again_first);
  int const n = active.first[sides], n_again = active.again_first[sides];
  active.node.resize(n);
  active.sample.resize(n);
  active.sample.gradient.resize(n);
  active.again.resize(n_again);
  active.again_at.resize(n_again);
  groups_of_items(lists.group, active.first, active.sample.group);
  groups_of_items(lists.group, active.again_first, active.again.group);
  parallel_for(queue, "node_gather/compact", sides,
               FillActive{scene,
                          lists.side,
                          active.due_first,
                          active.due_entry,
                          lists.node,
                          active.due.phi,
                          active.due.gradient,
                          active.graded,
                          active.due.point,
                          active.due.partner,
                          active.first,
                          active.node,
                          active.sample.point,
                          active.sample.partner,
                          active.sample.phi,
                          active.sample.gradient,
                          active.again_first,
                          active.again_at,
                          active.again.point,
                          active.again.partner},
               512);
  evaluate_phi_gradient(queue, scene, networks, active.again);
  active.fresh += n_again;
  parallel_for(queue, "node_gather/compact", n_again,
               CopyGradients{active.again_at, active.again.gradient, active.sample.gradient}, 512);
}

}  // namespace scree
