// node_gather.h: which surface nodes of a pair may be inside the partner, kept between steps as node lists.
// Conservative in every cull: the contact set equals brute force, which the tests assert.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/broad_phase.h"
#include "kernels/sdf_queries.h"

namespace scree {

// A side's list holds every node closer to the partner than a skin when the list was made (blocks of 32 nodes are
// rejected by geometry or by one query each; design inference.md section 1) and stays valid while the side travels less
// than its margin. A listed node that was phi < 0 outside cannot be inside before the side has travelled -phi / L: it
// is not evaluated again before that is due.

// Rotation matrices and spins of all bodies at the current poses, made once a step.
struct Kinematics {
  std::vector<Mat3> rotation;  // body -> world (n_bodies)
  std::vector<Vec3> spin;      // world [rad/s] (n_bodies)
};
struct KinematicsView {
  Span<const Mat3> rotation;
  Span<const Vec3> spin;
};
void compute_kinematics(Queue const& queue, SceneView const& scene, StateView const& state, Kinematics& kinematics);

// One side of a pair: the nodes of `carrier` against phi of `partner`.
struct Side {
  int pair;
  int carrier;  // body
  int partner;  // body, or -1 - plane
};

struct RelativePose {
  Vec3 position;  // of the carrier's centroid in the partner's frame [m]
  Quat orientation;
};

double constexpr was_inside = -1;

struct NodeLists {
  std::vector<Side> side;          // in the groups of QueryBatch by their partner; by pair within
  std::vector<int> group;          // first side of each group, end (query_groups + 1)
  std::vector<int> side_of_pair;   // [2 pair + (0: nodes of a | 1: nodes of b)]; -1: that side carries no nodes
  std::vector<RelativePose> pose;  // at the last step; of a wall's nodes: that of the grain they meet (n_sides)
  std::vector<double> travelled;   // bound on the way of the carrier's points past the partner since the list was made,
                                   // summed over steps [m] (n_sides)
  std::vector<double> margin;      // way the list covers [m]; negative: never built (n_sides)
  std::vector<int> first;          // (n_sides + 1)
  std::vector<int> node;           // relative to the shape's first node, ascending within a side
  std::vector<double> due;         // a listed node is outside while travelled < due [m]; was_inside: it was inside
                                   // at the last step (n_listed)
  std::int64_t nodes = 0;          // of all sides: what brute force evaluates at every step
  std::int64_t rebuilt = 0;        // sides rebuilt since the start
  std::int64_t block_queries = 0;
};

struct NodeGather {
  NodeLists lists;
  // Scratch of a rebuild. *_gap: distance proven to lie between what was left out and the partner [m].
  std::vector<int> stale, count, block_first, block_item, item_side, node_first, node_item;
  std::vector<double> skin, side_gap, block_gap, node_way;
  std::vector<int> next_first, next_node;
  std::vector<double> next_due;
  QueryBatch query;
};

// What phi of a side's partner is measured in [m].
SCREE_HD inline double partner_unit(SceneView const& scene, Side const& side) {
  return side.partner < 0 ? 1 : scene.diameter[side.partner];
}

// How far outside its partner a node of the side still carries force [m], as phi measures it: 0 without cohesion.
SCREE_HD inline double adhesive_reach(SceneView const& scene, Side const& side) {
  if (!(scene.cohesion_reach > 0)) return 0;
  int const other = side.partner < 0 ? scene.plane[-1 - side.partner].material : scene.material_of[side.partner];
  return scene.contact[scene.material_of[side.carrier] * scene.materials + other].cohesion.reach();
}

// Way [m] a side may travel before a node with this phi < 0 can carry force; 0 or less: it may now.
SCREE_HD inline double way_to_contact(SceneView const& scene, Side const& side, double phi) {
  double const reach = adhesive_reach(scene, side);
  if (side.partner < 0) return -phi - reach;
  ShapeRecord const& partner = scene.shape_record(side.partner);
  double const float_error = partner.net < 0 ? 0 : 2e-5;  // of two network queries [d], see sdf_batch.h
  double const way = (-phi - float_error) * scene.diameter[side.partner];
  if (!(reach > 0)) return way / partner.lipschitz;
  // Beyond the ball phi goes on with slope 1 along the ray, see sdf_queries.h.
  return (way - reach) / std::sqrt(partner.lipschitz * partner.lipschitz + 1);
}

// Sides for a new pair list. `old_pair[k]` is the index pair k had before, or -1; lists of surviving sides are kept.
// Pairs listed in `closed_form` (one flag a pair) get no sides.
void assign_sides(SceneView const& scene, int networks, Span<const Pair> pair, Span<const int> old_pair,
                  Span<const char> closed_form, NodeGather& gather, std::vector<int>& old_side);

// Steps of a pair's motion that the skin of a fresh list covers. A longer skin makes rebuilds rarer and lists longer;
// listed nodes cost little before they are due. `scree cost` sweeps it: tools/cost/skins.csv.
double constexpr steps_a_skin = 160;

struct GatherOptions {
  double time_step = 0;  // [s], from which a pair's skin follows its motion
  double skin_steps = steps_a_skin;
  bool brute_force = false;  // every node of every side, at every step
};

// Rebuild the lists whose pair has moved further than its margin.
void update_node_lists(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                       NetworkSet const& networks, GatherOptions const& options, NodeGather& gather);

// Nodes inside their partner (with cohesion: or within its reach) at this step, grouped as the sides are.
struct ActiveNodes {
  std::vector<int> first;  // (n_sides + 1)
  std::vector<int> node;   // relative to the shape's first node, ascending within a side
  QueryBatch sample;       // point, phi and gradient of each
  // Since the start, summed over steps: nodes of all sides, those in a list, those of them that were due and evaluated.
  std::int64_t nodes = 0, listed = 0, queries = 0;
  std::int64_t fresh = 0;  // those that came inside, and were evaluated again for their gradient
  // Scratch: the listed nodes that are due, and those of them that came inside.
  QueryBatch due, again;
  std::vector<char> graded;  // has a gradient (n_due)
  std::vector<int> due_first, due_entry, count, again_count, again_first, again_at;
};
// Evaluates the listed nodes that are due and says when they are due next. A node that was inside at the last step most
// likely still is: it gets phi and gradient in one pass. Which way a node went changes no bits of its result.
void find_active_nodes(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                       NetworkSet const& networks, GatherOptions const& options, NodeLists& lists, ActiveNodes& active);

// Carrier's point p [carrier's d, body frame] in the partner's frame and unit (see QueryBatch::point).
SCREE_HD inline Vec3 point_in_partner(SceneView const& scene, StateView const& state, KinematicsView const& kinematics,
                                      Side const& side, Vec3 p) {
  Vec3 const arm = kinematics.rotation[side.carrier] * (p * scene.diameter[side.carrier]);
  if (side.partner < 0) {
    PlaneRecord const& plane = scene.plane[-1 - side.partner];
    return {0, 0, dot(plane.normal, (state.position[side.carrier] - plane.point) + arm)};
  }
  Vec3 const offset = (state.position[side.carrier] - state.position[side.partner]) + arm;
  return transposed_times(kinematics.rotation[side.partner], offset) / scene.diameter[side.partner];
}

}  // namespace scree
