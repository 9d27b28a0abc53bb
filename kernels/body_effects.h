// body_effects.h: forces and brakes that act on single bodies. Each is a stage of its own, present only when the case
// names it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/contact_reduce.h"

namespace scree {

// external[i] += m_i g; acceleration g [m/s2] (n_bodies).
void apply_gravity(Queue const& queue, SceneView const& scene, Vec3 acceleration, Span<Wrench> external);

// Global damping of the settle stage: velocities decay by exp(-rate dt), exactly, whatever the step. The kinetic
// energy taken from body i is added to removed[i] [J]. rate [1/s].
void apply_global_damping(Queue const& queue, SceneView const& scene, StateView const& state, double rate, double dt,
                          Span<double> removed);

}  // namespace scree
