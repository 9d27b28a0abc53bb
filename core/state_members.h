// state_members.h: names every member of State once, for checkpoints to write and read and for tests to compare.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state.h"

namespace scree {

// What a restart would silently lose otherwise.
static_assert(sizeof(void*) != 8 || sizeof(State) == 752,
              "State has changed: name the new member in for_each_member, raise checkpoint_version, then this size");

// visit(name, member) for every member; S is State or State const. Order and names are those of the checkpoint file.
template <class S, class Visit>
void for_each_member(S& s, Visit const& visit) {
  visit("position", s.position);
  visit("velocity", s.velocity);
  visit("angular_momentum", s.angular_momentum);
  visit("orientation", s.orientation);
  visit("wrench_elastic", s.wrench.elastic);
  visit("wrench_damping", s.wrench.damping);
  visit("wrench_friction", s.wrench.friction);
  visit("wrench_rolling", s.wrench.rolling);
  visit("wrench_stiffness", s.wrench.stiffness);
  visit("node_history_first", s.node_history.first);
  visit("node_history_count", s.node_history.count);
  visit("node_history_node", s.node_history.node);
  visit("node_history_xi", s.node_history.xi);
  visit("sphere_history_xi", s.sphere_history.xi);
  visit("sphere_history_stiffness", s.sphere_history.stiffness);
  visit("rolling_history_angle", s.rolling_history.angle);
  visit("rolling_history_stiffness", s.rolling_history.stiffness);
  visit("work_damping", s.work_damping);
  visit("work_friction", s.work_friction);
  visit("removed_by_damping", s.removed_by_damping);
  visit("wall_work", s.wall_work);
  visit("work_applied", s.work_applied);
  visit("removed_by_drag", s.removed_by_drag);
  visit("work_rolling", s.work_rolling);
  visit("time", s.time);
  visit("time_step", s.time_step);
  visit("step", s.step);
  visit("activity", s.activity);
  visit("insertion", s.insertion);
  visit("deleted", s.deleted);
  visit("measure", s.measure);
  visit("damped", s.damped);
  visit("quiet_since", s.quiet_since);
  visit("initial_energy", s.initial_energy);
  visit("kinetic_peak", s.kinetic_peak);
  visit("deleted_energy", s.deleted_energy);
  visit("inserted_energy", s.inserted_energy);
  visit("exchanged_kinetic", s.exchanged_kinetic);
}

}  // namespace scree
