// restitution.h: coefficient of restitution against damping ratio, both ways, for each contact law.
// p_tot = max(0, p + beta p' dphi/dt) with beta = 2 zeta sqrt(m_e/K): the result depends on zeta alone, not on speed,
// mass, size or stiffness (design physics.md section 2), as long as the overlap passes the onset of the law by far.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/contact_laws.h"

namespace scree {

enum class DampingPath {
  nodes,   // every node clips at zero by itself (linear law: once a pair, see PressureLaw::damping_weight)
  sphere,  // the closed form clips the sum, once a pair
};

double constexpr largest_damping_ratio = 10;  // e is then 0.002 to 0.005, by law and path

// e in (0, 1] of a smooth convex impact at damping ratio zeta >= 0. Integrated to 1e-6 (winkler), 1e-4 (others).
double restitution_of(double zeta, DampingPath path, ContactLaw law = ContactLaw::winkler);

// zeta whose restitution is e. Throws std::invalid_argument unless 0 < e <= 1 and e is reached by the largest ratio.
double damping_ratio_for(double restitution, DampingPath path, ContactLaw law = ContactLaw::winkler);

}  // namespace scree
