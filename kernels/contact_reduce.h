// contact_reduce.h: from active nodes to pair wrenches and body wrenches, in a fixed order.
// Design physics.md sections 1-2: exact energy gradient, damping per pair, friction per node with its history.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/node_gather.h"

namespace scree {

struct Wrench {
  Vec3 force;   // [N]
  Vec3 torque;  // about the body's centroid [N m]

  SCREE_HD Wrench& operator+=(Wrench const& w) { return force += w.force, torque += w.torque, *this; }
};

// Forces of one kind between the bodies of a pair: on a, and the opposite one on b with b's own torque.
struct PairWrench {
  Vec3 force_on_a;          // [N]
  Vec3 torque_a, torque_b;  // about the own centroids [N m]
};

struct PairResult {
  PairWrench elastic, damping, friction;
  double energy_normal = 0;       // stored [J]
  double energy_tangential = 0;   // stored [J]
  double stiffness = 0;           // K_c of the critical step, max of normal and tangential [N/m]
  double arm2_a = 0, arm2_b = 0;  // squared distance contact point - centroid [m^2]
  double damping_ratio = 0;       // zeta of the material pair
  double overlap = 0;             // largest phi at a node [m]
  double depth = 0;               // largest phi at a node over the half thickness of the body it is in
  int active = 0;                 // nodes (or closed-form contacts) that carry force
  double friction_loss = 0;       // independent measure of the friction and tangential damping work of this step [J]
};

// Tangential history: xi [m, world frame] of the nodes that were active after the last step.
struct NodeHistory {
  std::vector<int> first, count;  // range of each side (n_sides)
  std::vector<int> node;          // ascending within a side
  std::vector<Vec3> xi;
};
// Closed-form spheres: one entry a pair.
struct SphereHistory {
  std::vector<Vec3> xi;           // [m] (n_pairs)
  std::vector<double> stiffness;  // tangential stiffness at which it was stored [N/m]; 0: no contact (n_pairs)
};

// Rolling resistance: what a pair remembers, and its couple. Arrays of all pairs, or empty without the effect.
struct RollingHistory {
  std::vector<Vec3> angle;        // elastic relative rotation, world frame [rad] (n_pairs)
  std::vector<double> stiffness;  // at which it was stored [N m]; 0: no contact (n_pairs)
};
struct RollingResult {
  Vec3 torque_on_a;          // [N m]; the opposite one acts on b
  double energy = 0;         // stored [J]
  double stiffness = 0;      // k_r [N m]
  double damping_ratio = 0;  // of the lighter body turning by itself
  double loss = 0;           // independent measure of the work lost in this step [J]
};
struct RollingView {
  Span<const Vec3> angle;
  Span<const double> stiffness;
  Span<Vec3> next_angle;
  Span<double> next_stiffness;
  Span<RollingResult> result;

  SCREE_HD bool on() const { return !result.empty(); }
};

struct ContactOptions {
  double time_step = 0;             // [s]
  bool normalise_gradient = false;  // wrong on purpose: the meter tests must notice it
};

// An active node in the world frame, made once for both passes.
struct NodeSample {
  Vec3 x;         // [m]
  Vec3 gradient;  // of phi with respect to x, [-]
  double phi;     // [m]
  double weight;  // s times area [m^2]
  double steep;   // |gradient|
};

// Pair results of all pairs with nodes; `next` receives the history of this step's active nodes. `samples` is scratch.
// Velocities in `state` are those at half step. Pairs in closed form are left untouched. in_contact[k] == 0 says that
// result[k] is a PairResult{}: most pairs of a list do not touch, and none of the stages has to look at theirs.
void reduce_node_contacts(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                          ContactOptions const& options, Span<const Pair> pair, Span<const char> closed_form,
                          NodeLists const& lists, ActiveNodes const& active, NodeHistory const& history,
                          NodeHistory& next, std::vector<NodeSample>& samples, RollingView const& rolling,
                          Span<PairResult> result, Span<char> in_contact);

// Closed-form contacts of spheres with spheres, planes and smooth walls.
void sphere_contacts(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                     ContactOptions const& options, Span<const Pair> pair, Span<const char> closed_form,
                     SphereHistory const& history, SphereHistory& next, RollingView const& rolling,
                     Span<PairResult> result, Span<char> in_contact);

// Which pairs a body takes part in: entry 2 pair + (0: as a, 1: as b), ascending (CSR over bodies).
struct PairsOfBodies {
  std::vector<int> first, entry;
};
void assign_pairs_to_bodies(int bodies, Span<const Pair> pair, PairsOfBodies& pairs);

struct BodyWrenches {
  std::vector<Wrench> elastic, damping, friction;  // (n_solids)
  std::vector<Vec3> rolling;                       // couples [N m] (n_solids), empty without rolling resistance
  std::vector<double> stiffness;                   // S_i of the critical step [1/s^2]; walls: 0 (n_solids)
};
void reduce_to_bodies(Queue const& queue, SceneView const& scene, Span<const PairResult> result,
                      Span<const char> in_contact, Span<const RollingResult> rolling, PairsOfBodies const& pairs,
                      BodyWrenches& bodies);

// Largest stable step of this contact network: (2/omega)(sqrt(1+zeta^2) - zeta), omega^2 = max over pairs (S_i + S_j);
// infinity without contact. Conservative (design physics.md section 4).
double critical_time_step(SceneView const& scene, Span<const Pair> pair, Span<const PairResult> result,
                          Span<const char> in_contact, Span<const RollingResult> rolling, Span<const double> stiffness);

}  // namespace scree
