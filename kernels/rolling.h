// rolling.h: rolling resistance of a pair: elastic-plastic spring-dashpot, type C of Ai, Chen, Rotter, Ooi, Powder
// Technol. 206 (2011) 269. Node contacts and closed-form spheres share it; one history entry a pair.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/tangential.h"

namespace scree {

// Adds the couple that resists the pair's relative rotation about axes in the tangent plane. n: unit normal; pressing:
// normal force with its damping [N]; stiffness: K of the contact [N/m]; arm2_a, arm2_b: squared lever arms [m^2].
// M = k_r theta + C_r w, |M| <= mu_r R_r F, k_r = ratio K (mu_r R_r)^2, C_r = 2 eta sqrt(I_r k_r), with
// 1/I_r = sum over bodies of 1/(I + m r^2), I the mean principal moment and R_r the effective radius. Where M is at its
// limit the dashpot gives way first (f = 0 in their equation 26).
SCREE_HD inline void resist_rolling(SceneView const& scene, KinematicsView const& kinematics,
                                    RollingView const& rolling, Pair const& pair, int k, double dt, Vec3 n,
                                    double pressing, double stiffness, double arm2_a, double arm2_b) {
  ContactParameters const& p = contact_parameters(scene, pair);
  rolling.next_angle[k] = {}, rolling.next_stiffness[k] = 0;
  rolling.result[k] = {};
  double const reach = p.rolling * effective_radius(scene, pair);
  double const k_r = p.rolling_ratio * stiffness * reach * reach;
  if (!(k_r > 0)) return;
  double compliance = 0, least = 0;
  Vec3 w;
  for (int side = 0; side < (pair.with_plane() ? 1 : 2); ++side) {
    int const body = side == 0 ? pair.a : pair.b;
    if (scene.is_wall(body)) {  // it turns as it is told
      w += kinematics.spin[body] * -1.0;
      continue;
    }
    Vec3 const inertia = scene.inertia[body];
    double smallest = inertia.x < inertia.y ? inertia.x : inertia.y;
    smallest = inertia.z < smallest ? inertia.z : smallest;
    least = side == 0 || smallest < least ? smallest : least;
    compliance += 1 / ((inertia.x + inertia.y + inertia.z) / 3 + scene.mass[body] * (side == 0 ? arm2_a : arm2_b));
    w += kinematics.spin[body] * (side == 0 ? 1.0 : -1.0);
  }
  double const c_r = 2 * p.rolling_damping * std::sqrt(k_r / compliance);
  Vec3 const kept = restored(rolling.angle[k], rolling.stiffness[k], k_r);
  double const given_up = 0.5 * (rolling.stiffness[k] * norm2(rolling.angle[k]) - k_r * norm2(kept));
  Vec3 const old = laid_flat(turned_by(mean_spin(kinematics, pair) * dt, kept), n);
  TangentialResult const t = slide(old, w - n * dot(n, w), dt, c_r / k_r, reach * pressing / k_r);
  rolling.next_angle[k] = t.xi;
  rolling.next_stiffness[k] = k_r;
  // Of a body that turns by itself, for the critical step.
  double const zeta = c_r / (2 * std::sqrt(k_r * least));
  rolling.result[k] = {t.traction * -k_r, 0.5 * k_r * norm2(t.xi), k_r, zeta, k_r * t.loss + given_up};
}

}  // namespace scree
