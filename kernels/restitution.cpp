// restitution.cpp: see restitution.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/restitution.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace scree {
namespace {

// Smooth convex impact in units where m = 1 and 2 pi R times the law's modulus = 1, without an onset: F = x^2/2, x or
// 2/3 x^(3/2), K = dF/dx. Over the cap phi runs from 0 to x, evenly in area; nodes with p + beta p' v <= 0 carry
// nothing.
double winkler_force(double x, double v, double zeta, DampingPath path) {
  double const beta = 2 * zeta / std::sqrt(x);
  if (path == DampingPath::sphere) return 0.5 * x * x + beta * x * v;
  double const shift = beta * v;
  return shift >= 0 ? 0.5 * x * x + shift * x : (x + shift > 0 ? 0.5 * (x + shift) * (x + shift) : 0);
}

double hertz_force(double x, double v, double zeta, DampingPath path) {
  double const root = std::sqrt(x), stiffness = root, beta = 2 * zeta / std::sqrt(stiffness);
  if (path == DampingPath::sphere) return 2.0 / 3 * x * root + beta * stiffness * v;
  // p_tot = sqrt(phi) + beta v / (2 sqrt(phi)) is positive from phi = -beta v / 2 on.
  double const from = v < 0 ? -0.5 * beta * v : 0;
  if (from >= x) return 0;
  double const root_from = std::sqrt(from);
  return 2.0 / 3 * (x * root - from * root_from) + beta * v * (root - root_from);
}

double acceleration(double x, double v, double zeta, DampingPath path, ContactLaw law) {
  if (x <= 0) return 0;
  double force = 0;
  if (law == ContactLaw::winkler) force = winkler_force(x, v, zeta, path);
  if (law == ContactLaw::linear) force = x + 2 * zeta * v;  // K = 1; both paths clip once a pair
  if (law == ContactLaw::hertz) force = hertz_force(x, v, zeta, path);
  return force > 0 ? -force : 0;
}

}  // namespace

double restitution_of(double zeta, DampingPath path, ContactLaw law) {
  double x = 0, v = 1;
  double const dt = 2e-4;
  // Half a period is about 3 units; damping and clipping stretch it. A contact that no longer pushes leaves at v.
  for (int i = 0; i < 400000; ++i) {
    double const k1 = acceleration(x, v, zeta, path, law),
                 k2 = acceleration(x + 0.5 * dt * v, v + 0.5 * dt * k1, zeta, path, law);
    double const k3 = acceleration(x + 0.5 * dt * (v + 0.5 * dt * k1), v + 0.5 * dt * k2, zeta, path, law);
    double const k4 = acceleration(x + dt * (v + 0.5 * dt * k2), v + dt * k3, zeta, path, law);
    x += dt * (v + dt * (k1 + k2 + k3) / 6);
    v += dt * (k1 + 2 * k2 + 2 * k3 + k4) / 6;
    if (x <= 0 && v < 0) break;
  }
  return -v;
}

double damping_ratio_for(double restitution, DampingPath path, ContactLaw law) {
  if (!(restitution > 0 && restitution <= 1))
    throw std::invalid_argument("restitution " + std::to_string(restitution) + " is outside (0, 1]");
  if (restitution == 1) return 0;
  double low = 0, high = largest_damping_ratio;
  if (restitution_of(high, path, law) > restitution)
    throw std::invalid_argument("restitution " + std::to_string(restitution) +
                                " is below what the damping law reaches");
  for (int i = 0; i < 50; ++i) {
    double const mid = 0.5 * (low + high);
    (restitution_of(mid, path, law) > restitution ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

}  // namespace scree
