// contacts.h: one evaluation of all contact forces at the current poses: pair list, node lists, networks, reduction.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/effects.h"
#include "core/state.h"

namespace scree {

struct ContactSettings {
  bool brute_force = false;
  bool normalise_gradient = false;
};

// Wrenches of `state` at its poses and (half-step) velocities; history advances by `dt`.
void evaluate_contacts(Queue const& queue, Scene const& scene, Effects const& effects, ContactSettings const& settings,
                       double dt, State& state, Workspace& work);

}  // namespace scree
