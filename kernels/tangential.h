// tangential.h: what node contacts and closed-form spheres share: the damping of a pair and the tangential spring.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/contact_reduce.h"

namespace scree {

SCREE_HD inline Vec3 centre_of_b(SceneView const&, StateView const& state, Pair const& pair) {
  return pair.with_plane() ? Vec3{} : state.position[pair.b];
}

// Velocity of a body's point x, or 0 for a plane.
SCREE_HD inline Vec3 point_velocity(StateView const& state, KinematicsView const& kinematics, int body, Vec3 x) {
  if (body < 0) return {};
  return state.velocity[body] + cross(kinematics.spin[body], x - state.position[body]);
}

// 1/m_e of the pair at point x along the unit direction n: both translations and both lever arms [1/kg].
SCREE_HD inline double inverse_effective_mass(SceneView const& scene, StateView const& state,
                                              KinematicsView const& kinematics, Pair const& pair, Vec3 x, Vec3 n) {
  double sum = 0;
  for (int k = 0; k < (pair.with_plane() ? 1 : 2); ++k) {
    int const body = k == 0 ? pair.a : pair.b;
    Vec3 const arm = cross(x - state.position[body], n);
    sum += 1 / scene.mass[body] + dot(arm, inverse_inertia_times(kinematics.rotation[body], scene.inertia[body], arm));
  }
  return sum;
}

SCREE_HD inline ContactParameters const& contact_parameters(SceneView const& scene, Pair const& pair) {
  int const mb = pair.with_plane() ? scene.plane[pair.plane()].material : scene.material_of[pair.b];
  return scene.contact[scene.material_of[pair.a] * scene.materials + mb];
}

// R* of the equal-volume spheres of a pair [m]; a wall counts as flat.
SCREE_HD inline double effective_radius(SceneView const& scene, Pair const& pair) {
  double const ra = 0.5 * scene.diameter[pair.a];
  if (pair.with_plane() || scene.is_wall(pair.b)) return ra;
  double const rb = 0.5 * scene.diameter[pair.b];
  return ra * rb / (ra + rb);
}

SCREE_HD inline Vec3 mean_spin(KinematicsView const& kinematics, Pair const& pair) {
  Vec3 const wa = kinematics.spin[pair.a];
  return pair.with_plane() ? wa * 0.5 : (wa + kinematics.spin[pair.b]) * 0.5;
}
// How the pair turns in a step: made once a pair, for all of its springs.
SCREE_HD inline Mat3 mean_turn(KinematicsView const& kinematics, Pair const& pair, double time_step) {
  return to_matrix(quat_from_rotation_vector(mean_spin(kinematics, pair) * time_step));
}

// x turned by the vector `angle` (axis times angle [rad]), for one vector; for many, make the matrix. The series of
// sin(a)/a and (1 - cos(a))/a^2 end below the last bit for angles up to 0.1.
SCREE_HD inline Vec3 turned_by(Vec3 angle, Vec3 x) {
  double const a2 = norm2(angle);
  if (a2 > 0.01) return to_matrix(quat_from_rotation_vector(angle)) * x;
  double const s = 1 - a2 * (1.0 / 6 - a2 * (1.0 / 120 - a2 * (1.0 / 5040 - a2 / 362880)));
  double const c = 0.5 - a2 * (1.0 / 24 - a2 * (1.0 / 720 - a2 * (1.0 / 40320 - a2 / 3628800)));
  Vec3 const across = cross(angle, x);
  return x + across * s + cross(angle, across) * c;
}

// What was turned with its pair, laid into the tangent plane of unit normal n, and given its length back.
SCREE_HD inline Vec3 laid_flat(Vec3 turned, Vec3 n) {
  Vec3 const flat = turned - n * dot(n, turned);
  double const flat2 = norm2(flat);
  return flat2 > 0 ? flat * std::sqrt(norm2(turned) / flat2) : Vec3{};
}

// xi of the last step carried to this one: turned with the pair (mean_turn), then laid flat. Projection alone would
// lose the force as the pair turns.
SCREE_HD inline Vec3 transport(Vec3 xi, Mat3 const& turn, Vec3 n) { return laid_flat(turn * xi, n); }

// Stretch of a spring whose stiffness was `before` (0: there was none) and is `now`: the force is kept when the contact
// stiffens, the stretch when it softens. Neither makes energy.
SCREE_HD inline Vec3 restored(Vec3 stretch, double before, double now) {
  if (!(before > 0)) return {};
  return before < now ? stretch * (before / now) : stretch;
}

struct TangentialResult {
  Vec3 xi;        // to store [m]
  Vec3 traction;  // spring plus dashpot, in units of [m]: times stiffness gives the force against the motion
  double loss;    // work lost this step per unit stiffness [m^2]
};

// Spring with Coulomb limit. xi_old: transported; v: tangential velocity of the carrier relative to its partner;
// beta: dashpot time [s]; limit: mu times normal force over tangential stiffness [m].
SCREE_HD inline TangentialResult slide(Vec3 xi_old, Vec3 v, double dt, double beta, double limit) {
  Vec3 const trial = xi_old + v * dt;
  double const stretched2 = norm2(trial), limit2 = limit * limit;  // most contacts stick: they need no root
  Vec3 const xi = stretched2 > limit2 ? trial * (limit / std::sqrt(stretched2)) : trial;
  Vec3 total = xi + v * beta;
  double const size2 = norm2(total);
  if (size2 > limit2) total = total * (limit / std::sqrt(size2));
  // Plastic part by the trapezoidal rule (exact for a linear spring), viscous part by the dashpot's force.
  double const loss = 0.5 * dot(xi_old + xi, trial - xi) + dot(total - xi, v) * dt;
  return {xi, total, loss};
}

}  // namespace scree
