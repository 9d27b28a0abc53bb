// contacts.h: one evaluation of all contact forces at the current poses: pair list, node lists, networks, reduction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/effects.h"
#include "core/state.h"

namespace scree {

struct ContactSettings {
  bool brute_force = false;
  double skin_steps = steps_a_skin;
  bool normalise_gradient = false;
};

// Wrenches of `state` at its poses and (half-step) velocities; history advances by `dt`.
void evaluate_contacts(Queue const& queue, Scene const& scene, Effects const& effects, ContactSettings const& settings,
                       double dt, State& state, Workspace& work);

// Takes over the pair list of a checkpoint, made at the poses built_* (empty: used up), and makes its sides with node
// lists that are yet to be built. Histories in the order of that list stay valid.
void restore_pairs(Scene const& scene, std::vector<Pair> const& pair, std::vector<Vec3> const& built_position,
                   std::vector<Quat> const& built_orientation, Workspace& work);

}  // namespace scree
