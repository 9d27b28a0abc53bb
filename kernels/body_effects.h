// body_effects.h: forces and brakes that act on single bodies. Each is a stage of its own, present only when the case
// names it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/contact_reduce.h"

namespace scree {

// external[i] += m_i g; acceleration g [m/s2] (n_bodies).
void apply_gravity(Queue const& queue, SceneView const& scene, Vec3 acceleration, Span<Wrench> external);

// Global damping: velocities decay by exp(-rate dt), exactly, whatever the step. The kinetic energy taken from body i
// is added to removed[i] [J]. rate [1/s]. `name`: of the launch, the settle stage and [damping] differ.
void apply_global_damping(Queue const& queue, char const* name, SceneView const& scene, StateView const& state,
                          double rate, double dt, Span<double> removed);

// Quadratic drag of the equal-volume sphere, acting alone over dt: with u the velocity relative to the fluid and
// k = density coefficient (pi d^2 / 4) / (2 m), u' = -k |u| u has the solution u / (1 + k |u| dt), so the stage is
// exact, stable for any step, and the kinetic energy taken from body i, added to removed[i] [J], is exact too; a fluid
// that drives bodies makes it negative.
struct DragParameters {
  double density = 0;      // of the fluid [kg/m3]
  double coefficient = 0;  // [-]
  Vec3 fluid_velocity;     // [m/s]
};
void apply_drag(Queue const& queue, SceneView const& scene, StateView const& state, DragParameters const& drag,
                double dt, Span<double> removed);

// applied[i] = of_group[group_of[i]] (n_bodies).
void apply_group_forces(Queue const& queue, SceneView const& scene, Span<const int> group_of,
                        Span<const Wrench> of_group, Span<Wrench> applied);

// A region that bodies leave the simulation in: a box, its inside or its outside, or all that is behind a plane.
struct DeleteRegion {
  bool plane = false, inside = false;
  Box box;             // [m]
  Vec3 point, normal;  // plane [m]
};
// leaving[i] = the first region that active body i has its centroid in; -1: none (n_bodies).
void find_leaving(Queue const& queue, SceneView const& scene, StateView const& state, Span<const DeleteRegion> region,
                  Span<int> leaving);

}  // namespace scree
