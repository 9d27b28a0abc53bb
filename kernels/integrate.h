// integrate.h: velocity Verlet for translations, symmetric free-rotor splitting for rotations.
// Angular momentum is state (world frame), so a free body keeps it exactly; the rotation is advanced by exact turns
// about the body's principal axes (Dullweber, Leimkuhler, McLachlan, J. Chem. Phys. 107 (1997) 5840), which is
// symplectic and keeps the energy error bounded for any number of steps.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/contact_reduce.h"

namespace scree {

// Wrenches of a step by kind, as the ledger needs them (n_bodies each).
struct WrenchesView {
  Span<const Wrench> elastic, damping, friction, external;
  Span<const Wrench> applied;  // empty: none
  Span<const Vec3> rolling;    // couples of rolling resistance [N m]; empty: none
};

// Work done on each solid since the start, by kind [J] (n_solids each): half-step velocity times the mean of the old
// and the new force, so that kinetic energy plus these close to second order in the step. wall: done by each wall on
// the grains, forces of all kinds (n_walls).
struct WorkView {
  Span<double> damping, friction, wall;
  Span<double> applied;  // empty: none
  Span<double> rolling;  // empty: none
};

// Half kick with the wrenches of step n, then drift over dt: leaves half-step velocities at the poses of step n + 1.
// Walls already stand there, with their mean velocities of the step.
void open_step(Queue const& queue, SceneView const& scene, StateView const& state, WrenchesView const& wrenches,
               double dt, WorkView const& work);

// Half kick with the wrenches of step n + 1: velocities and poses are synchronised again.
void close_step(Queue const& queue, SceneView const& scene, StateView const& state, WrenchesView const& wrenches,
                double dt, WorkView const& work);

// Orientation of a free body after dt; its angular momentum (world) stays. inertia: principal [kg m2].
SCREE_HD Quat rotate_free(Quat orientation, Vec3 inertia, Vec3 angular_momentum, double dt);

// Translational plus rotational kinetic energy of body i [J].
SCREE_HD inline double kinetic_energy(SceneView const& scene, StateView const& state, int i) {
  Vec3 const local = transposed_times(to_matrix(state.orientation[i]), state.angular_momentum[i]);
  return 0.5 * (scene.mass[i] * norm2(state.velocity[i]) + dot(local, divide(local, scene.inertia[i])));
}

SCREE_HD inline Quat rotate_free(Quat q, Vec3 inertia, Vec3 angular_momentum, double dt) {
  Vec3 l = transposed_times(to_matrix(q), angular_momentum);  // body frame
  int constexpr axis[5] = {0, 1, 2, 1, 0};
  double constexpr part[5] = {0.5, 0.5, 1, 0.5, 0.5};
  for (int k = 0; k < 5; ++k) {
    int const i = axis[k], j = (i + 1) % 3, m = (i + 2) % 3;
    double const angle = part[k] * dt * l[i] / inertia[i];
    double const c = std::cos(angle), s = std::sin(angle);
    double const lj = l[j], lm = l[m];
    l[j] = c * lj + s * lm;  // the frame turns by `angle`, components by the opposite
    l[m] = c * lm - s * lj;
    double const half_sine = std::sin(angle / 2);
    q = q * Quat{std::cos(angle / 2), i == 0 ? half_sine : 0, i == 1 ? half_sine : 0, i == 2 ? half_sine : 0};
  }
  return normalized(q);
}

}  // namespace scree
