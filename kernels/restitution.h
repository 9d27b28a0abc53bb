// restitution.h: coefficient of restitution against damping ratio, both ways, for the Winkler law.
// p_tot = max(0, p + beta p' dphi/dt) with beta = 2 zeta sqrt(m_e/K): the result depends on zeta alone, not on speed,
// mass, size or stiffness (design physics.md section 2).
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace scree {

enum class DampingPath {
  nodes,   // every node clips at zero by itself
  sphere,  // the closed form clips the sum, once a pair
};

// e in (0, 1] of a smooth convex impact at damping ratio zeta >= 0. Integrated to 1e-6.
double restitution_of(double zeta, DampingPath path);

// zeta whose restitution is e. Throws std::invalid_argument unless 0 < e <= 1 and the law reaches e (about 0.02).
double damping_ratio_for(double restitution, DampingPath path);

}  // namespace scree
