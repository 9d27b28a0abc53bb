// contact_laws.h: normal pressure laws p(phi) = psi'(phi) on surface nodes, and their closed forms for spheres.
// One stored energy E = s sum A psi(phi); force, stiffness and time step all derive from it (design physics.md 1;
// Feng, CMAME 373 (2021) 113454; Lai, Zhao, Zhao, Huang, Comput. Mech. 70 (2022) 763).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/config.h"

namespace scree {

// Winkler foundation, p = kappa phi. Overlap phi [m] > 0.
struct WinklerLaw {
  double kappa;  // [N/m3]

  SCREE_HD double pressure(double phi) const { return kappa * phi; }            // [Pa]
  SCREE_HD double slope(double) const { return kappa; }                         // dp/dphi [N/m3]
  SCREE_HD double energy(double phi) const { return 0.5 * kappa * phi * phi; }  // psi [J/m2]
};

// The same law between smooth convex surfaces of effective radius R (1/R = 1/R1 + 1/R2), F = 2 pi R psi(overlap):
// exact in the limit overlap << R.
struct WinklerSphere {
  static constexpr double pi = 3.141592653589793;
  double kappa;   // [N/m3]
  double radius;  // effective [m]

  SCREE_HD double force(double overlap) const { return pi * radius * kappa * overlap * overlap; }  // [N]
  SCREE_HD double stiffness(double overlap) const { return 2 * pi * radius * kappa * overlap; }    // [N/m]
  SCREE_HD double energy(double overlap) const { return force(overlap) * overlap / 3; }            // [J]
};

// kappa of a material whose secant stiffness F/overlap is `stiffness` [N/m] at `overlap` [m] between equal spheres of
// diameter d: F = pi R kappa overlap^2 with R = d/4.
inline double winkler_modulus(double stiffness, double diameter, double overlap) {
  return stiffness / (WinklerSphere::pi * (diameter / 4) * overlap);
}

}  // namespace scree
