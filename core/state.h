// state.h: everything that changes from step to step and would have to be saved; and the scratch that need not be.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/scene.h"
#include "kernels/contact_reduce.h"
#include "kernels/integrate.h"

namespace scree {

// Insertion over time of one [[grains]] entry of one replica, in the order of its bodies.
struct Insertion {
  int done = 0;               // bodies inserted
  std::uint64_t random = 0;   // of the places tried
  double blocked_since = -1;  // [s]; -1: not blocked
  std::int64_t blocked_times = 0;
  double blocked_seconds = 0;  // of the times that are over
};

// Mean and spread of one quantity as it is sampled.
struct Moments {
  std::int64_t samples = 0;  // in the window of the measurement
  double mean = 0;
  double squares = 0;  // sum of squared differences to the mean
  double last = std::numeric_limits<double>::quiet_NaN();
};

// What one [[measure]] entry keeps, see core/measurements.h.
struct Measurement {
  std::int64_t next = 1;       // the next sample is due at next x every
  double last_time = 0;        // of the last sample [s]
  std::vector<double> memory;  // of its kind
  std::vector<Moments> moments;
};

struct State {
  // Of grains, then of walls (n_solids). A wall's velocity is its mean over the last step.
  std::vector<Vec3> position, velocity, angular_momentum;
  std::vector<Quat> orientation;
  BodyWrenches wrench;  // of the last step: the next one opens with them
  NodeHistory node_history;
  SphereHistory sphere_history;
  RollingHistory rolling_history;
  std::vector<double> work_damping, work_friction;    // since the start [J] (n_solids)
  std::vector<double> removed_by_damping;             // since the start [J] (n_bodies)
  std::vector<double> wall_work;                      // done by each wall since the start [J] (n_walls)
  std::vector<double> work_applied, removed_by_drag;  // ... (n_bodies), empty without the effect
  std::vector<double> work_rolling;                   // ... (n_solids), empty without the effect
  double time = 0, time_step = 0;                     // [s]
  std::int64_t step = 0;
  // Of runs with insertion over time or deletion; else empty.
  std::vector<Activity> activity;     // (n_bodies)
  std::vector<Insertion> insertion;   // (n_entries, see core/grain_entries.h); empty without insertion over time
  std::vector<std::int64_t> deleted;  // bodies that left, by [[delete]] entry
  std::vector<Measurement> measure;   // (n_measures)
  // Settle schedule.
  bool damped = false;
  double quiet_since = -1;  // [s]; -1: not quiet
  // Ledger.
  double initial_energy = 0, kinetic_peak = 0;  // [J]
  double deleted_energy = 0;     // of bodies that were deleted, with the elastic energy of their contacts [J]
  double inserted_energy = 0;    // kinetic and potential energy that insertion brought in [J]
  double exchanged_kinetic = 0;  // kinetic energy of all that came or went: potential energy has no zero to be moved
                                 // against [J]

  bool is_active(std::size_t body) const { return body >= activity.size() || activity[body] == Activity::active; }

  StateView view() { return {position, orientation, velocity, angular_momentum, activity}; }
};

struct Workspace {
  std::vector<Wrench> external;              // constant during a run: gravity
  std::vector<Wrench> group_force, applied;  // of [[force]]: (n_groups), (n_bodies), empty without one
  std::vector<Box> box;
  std::vector<double> skin;  // of the pair list [m] (n_bodies)
  std::vector<Vec3> built_position;
  std::vector<Quat> built_orientation;
  BroadPhase broad_phase;
  std::vector<Pair> pair;
  std::vector<int> old_pair, old_side;
  std::vector<char> closed_form;  // (n_pairs)
  PairsOfBodies pairs_of_bodies;
  Kinematics kinematics;
  NodeGather gather;
  ActiveNodes active;
  NodeHistory next_node_history;
  std::vector<NodeSample> samples;  // (n_active)
  SphereHistory next_sphere_history;
  RollingHistory next_rolling_history;
  std::vector<PairResult> result;
  std::vector<char> in_contact;        // 0: the pair's result is PairResult{} (n_pairs)
  std::vector<RollingResult> rolling;  // (n_pairs), empty without rolling resistance
  std::vector<double> kinetic;         // [J] (n_bodies)
  std::vector<int> leaving;  // [[delete]] entry that takes a body; -1: none (n_bodies), empty without deletion
  std::int64_t pair_rebuilds = 0;

  WrenchesView wrenches(BodyWrenches const& b) const {
    return {b.elastic, b.damping, b.friction, external, applied, b.rolling};
  }
};

}  // namespace scree
