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
  if (is_isotropic(scene.inertia[i]))
    return 0.5 * (scene.mass[i] * norm2(state.velocity[i]) + norm2(state.angular_momentum[i]) / scene.inertia[i].x);
  Vec3 const local = transposed_times(to_matrix(state.orientation[i]), state.angular_momentum[i]);
  return 0.5 * (scene.mass[i] * norm2(state.velocity[i]) + dot(local, divide(local, scene.inertia[i])));
}

// Sine and cosine of half an angle [rad]. In a time step angles are small: up to 0.1 by series that end below the last
// bit there.
struct HalfAngle {
  double sine, cosine;

  SCREE_HD explicit HalfAngle(double angle) {
    double const h = 0.5 * angle, h2 = h * h;
    if (h2 > 0.0025) {
      sine = std::sin(h), cosine = std::cos(h);
      return;
    }
    sine = h * (1 - h2 * (1.0 / 6 - h2 * (1.0 / 120 - h2 * (1.0 / 5040 - h2 / 362880))));
    cosine = 1 - h2 * (0.5 - h2 * (1.0 / 24 - h2 * (1.0 / 720 - h2 * (1.0 / 40320 - h2 / 3628800))));
  }
};

// Orientation of a ball after one turn about a fixed axis, by the vector `angle` (axis times angle [rad]).
SCREE_HD inline Quat turn_ball(Quat q, Vec3 angle) {
  double const a = norm(angle);
  if (!(a > 0)) return q;
  HalfAngle const half(a);
  double const s = half.sine / a;
  return normalized(Quat{half.cosine, angle.x * s, angle.y * s, angle.z * s} * q);
}

SCREE_HD inline Quat rotate_free(Quat q, Vec3 inertia, Vec3 angular_momentum, double dt) {
  if (is_isotropic(inertia)) return turn_ball(q, angular_momentum * (dt / inertia.x));
  Vec3 l = transposed_times(to_matrix(q), angular_momentum);  // body frame
  int constexpr axis[5] = {0, 1, 2, 1, 0};
  double constexpr part[5] = {0.5, 0.5, 1, 0.5, 0.5};
  for (int k = 0; k < 5; ++k) {
    int const i = axis[k], j = (i + 1) % 3, m = (i + 2) % 3;
    HalfAngle const half(part[k] * dt * l[i] / inertia[i]);
    double const c = 1 - 2 * half.sine * half.sine, s = 2 * half.sine * half.cosine;
    double const lj = l[j], lm = l[m];
    l[j] = c * lj + s * lm;  // the frame turns by the angle, components by the opposite
    l[m] = c * lm - s * lj;
    q = q * Quat{half.cosine, i == 0 ? half.sine : 0, i == 1 ? half.sine : 0, i == 2 ? half.sine : 0};
  }
  return normalized(q);
}

}  // namespace scree
