// effect_stages.h: effects on single bodies within a step: when they act and how strongly. Kernels: body_effects.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/effects.h"
#include "core/state.h"

namespace scree {

// Drag and global damping of the case, over dt, at a synchronised point. Half a step before and half a step after the
// contact forces keeps the whole step second order (Strang 1968).
void brake_bodies(Queue const& queue, Case const& c, Effects const& effects, SceneView const& view, double dt,
                  State& state);

// work.applied = the mean of [[force]] over [from, to]: each kick gets the impulse of its own half step, so windows and
// tables pass on their whole impulse whatever the step.
void push_bodies(Queue const& queue, Case const& c, Scene const& scene, double from, double to, Workspace& work);

}  // namespace scree
