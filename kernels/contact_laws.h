// contact_laws.h: normal pressure laws p(phi) = psi'(phi) on surface nodes, and their closed forms for spheres.
// One stored energy E = s sum A psi(phi); force, stiffness and time step all derive from it (design physics.md 1;
// Feng, CMAME 373 (2021) 113454; Lai, Zhao, Zhao, Huang, Comput. Mech. 70 (2022) 763).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/config.h"

namespace scree {

enum class ContactLaw {
  winkler,  // p = kappa phi
  linear,   // p = c min(1, phi / onset): smooth contacts carry k_n overlap
  hertz,    // p = c sqrt(phi), a straight line below the onset, where p' would be infinite
};

// Pressure of one law over the overlap phi [m] > 0. psi and p are continuous everywhere (E is C1).
struct PressureLaw {
  ContactLaw kind = ContactLaw::winkler;
  double modulus = 0;    // winkler: kappa [N/m3]; linear: c [Pa]; hertz: c [Pa/m^1/2]. 0: no law given
  double onset = 0;      // linear, hertz: p rises in a straight line up to this overlap [m]
  double reference = 0;  // linear, hertz: overlap whose secant p/phi scales the friction stiffness [m]

  SCREE_HD double pressure(double phi) const {  // [Pa]
    switch (kind) {
      case ContactLaw::linear:
        return phi < onset ? modulus * (phi / onset) : modulus;
      case ContactLaw::hertz:
        return phi < onset ? modulus * phi / std::sqrt(onset) : modulus * std::sqrt(phi);
      default:
        return modulus * phi;
    }
  }
  SCREE_HD double slope(double phi) const {  // dp/dphi [N/m3]; largest at touch
    switch (kind) {
      case ContactLaw::linear:
        return phi < onset ? modulus / onset : 0;
      case ContactLaw::hertz:
        return phi < onset ? modulus / std::sqrt(onset) : 0.5 * modulus / std::sqrt(phi);
      default:
        return modulus;
    }
  }
  SCREE_HD double energy(double phi) const {  // psi [J/m2]
    switch (kind) {
      case ContactLaw::linear:
        return phi < onset ? 0.5 * modulus * phi * (phi / onset) : modulus * (phi - 0.5 * onset);
      case ContactLaw::hertz:
        return phi < onset ? 0.5 * modulus * phi * phi / std::sqrt(onset)
                           : modulus * (2.0 / 3 * phi * std::sqrt(phi) - onset * std::sqrt(onset) / 6);
      default:
        return 0.5 * modulus * phi * phi;
    }
  }
  SCREE_HD double energy_integral(double phi) const {  // of psi from 0 to phi [J/m]
    switch (kind) {
      case ContactLaw::linear:
        return phi < onset ? modulus * phi * phi * (phi / onset) / 6
                           : modulus * (0.5 * phi * (phi - onset) + onset * onset / 6);
      case ContactLaw::hertz:
        return phi < onset ? modulus * phi * phi * phi / (6 * std::sqrt(onset))
                           : modulus * (4.0 / 15 * phi * phi * std::sqrt(phi) - onset * std::sqrt(onset) * phi / 6 +
                                        onset * onset * std::sqrt(onset) / 15);
      default:
        return modulus * phi * phi * phi / 6;
    }
  }

  // Modulus of the tangential springs is this times k_t/k_n [N/m3]: a constant, so that springs of fixed stiffness make
  // no energy. Winkler: kappa; else the secant at the reference overlap.
  SCREE_HD double secant() const { return kind == ContactLaw::winkler ? modulus : pressure(reference) / reference; }

  // Share of the pair's damping that a node takes. By p' where every node has some; p' of the linear law lives in the
  // onset alone, where 1,000 nodes have about one: there damping goes with the pressure, and clips once a pair.
  SCREE_HD double damping_weight(double phi) const { return kind == ContactLaw::linear ? pressure(phi) : slope(phi); }
};

// The law of a pair of effective radius R [m] from that of its materials: Hertz's c is (E* / pi) / sqrt(R), others do
// not depend on it.
SCREE_HD inline PressureLaw law_at_radius(PressureLaw law, double radius) {
  if (law.kind == ContactLaw::hertz) law.modulus /= std::sqrt(radius);
  return law;
}

// The same law between smooth convex surfaces of effective radius R (1/R = 1/R1 + 1/R2), F = 2 pi R psi(overlap):
// exact in the limit overlap << R.
struct SphereLaw {
  static constexpr double pi = 3.141592653589793;
  PressureLaw law;  // of the pair
  double radius;    // effective [m]

  SCREE_HD double force(double overlap) const {  // [N]
    if (law.kind == ContactLaw::winkler) return pi * radius * law.modulus * overlap * overlap;
    return 2 * pi * radius * law.energy(overlap);
  }
  SCREE_HD double stiffness(double overlap) const {  // dF/d overlap [N/m]
    if (law.kind == ContactLaw::winkler) return 2 * pi * radius * law.modulus * overlap;
    return 2 * pi * radius * law.pressure(overlap);
  }
  SCREE_HD double energy(double overlap) const {  // [J]
    if (law.kind == ContactLaw::winkler) return force(overlap) * overlap / 3;
    return 2 * pi * radius * law.energy_integral(overlap);
  }
  // Of the tangential spring, per k_t/k_n [N/m]: what nodes with secant() would add up to on the same cap.
  SCREE_HD double tangential(double overlap) const { return 2 * pi * radius * law.secant() * overlap; }
};

// Adhesive traction, constant up to a range outside the surface: p = -traction for phi > -range, psi(0) = -traction x
// range. The edge is a straight ramp from 1.1 to 0.9 of the range: a step of p would put an error into the energy at
// every node that passes it. Smooth surfaces: F = 2 pi R psi, so a contact that its law cannot deform pulls off at 2 pi
// R traction range.
struct Cohesion {
  static constexpr double half_ramp = 0.1;  // of the range
  double traction = 0;                      // [Pa]; 0: none
  double range = 0;                         // [m]

  SCREE_HD double reach() const { return (1 + half_ramp) * range; }  // [m]
  SCREE_HD double ramp() const { return 2 * half_ramp * range; }     // [m]
  SCREE_HD double pressure(double phi) const {                       // [Pa], negative
    double const u = phi + reach();
    return u > 0 ? (u < ramp() ? -traction * (u / ramp()) : -traction) : 0;
  }
  SCREE_HD double slope(double phi) const {  // |dp/dphi| [N/m3]
    double const u = phi + reach();
    return u > 0 && u < ramp() ? traction / ramp() : 0;
  }
  SCREE_HD double energy(double phi) const {  // psi [J/m2]
    double const u = phi + reach();
    if (!(u > 0)) return 0;
    return u < ramp() ? -0.5 * traction * u * (u / ramp()) : -traction * (phi + range);
  }
  SCREE_HD double energy_integral(double phi) const {  // of psi from outside the reach to phi [J/m]
    double const u = phi + reach(), w = ramp();
    if (!(u > 0)) return 0;
    return u < w ? -traction * u * u * (u / w) / 6 : -traction * (0.5 * u * (u - w) + w * w / 6);
  }
};

// kappa of a material whose secant stiffness F/overlap is `stiffness` [N/m] at `overlap` [m] between equal spheres of
// diameter d: F = pi R kappa overlap^2 with R = d/4.
inline double winkler_modulus(double stiffness, double diameter, double overlap) {
  return stiffness / (SphereLaw::pi * (diameter / 4) * overlap);
}
// c of the linear law whose stiffness between equal spheres of diameter d is k_n [N/m] beyond the onset.
inline double linear_modulus(double stiffness, double diameter) {
  return stiffness / (2 * SphereLaw::pi * (diameter / 4));
}
// E* / pi of Hertz's law for two bodies of Young's modulus E [Pa] and Poisson's ratio nu: E* = E / (2 (1 - nu^2)).
inline double hertz_modulus(double youngs_modulus, double poisson_ratio) {
  return youngs_modulus / (2 * (1 - poisson_ratio * poisson_ratio)) / SphereLaw::pi;
}

}  // namespace scree
