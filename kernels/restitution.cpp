// restitution.cpp: see restitution.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/restitution.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace scree {
namespace {

// Smooth convex impact in units where m = 1, 2 pi R kappa = 1: K = x, elastic force x^2/2.
double acceleration(double x, double v, double zeta, DampingPath path) {
  if (x <= 0) return 0;
  double const beta = 2 * zeta / std::sqrt(x);
  double force;
  if (path == DampingPath::sphere) {
    force = 0.5 * x * x + beta * x * v;
  } else {
    // phi runs from 0 to x over the cap; nodes with phi + beta v <= 0 carry nothing.
    double const shift = beta * v;
    force = shift >= 0 ? 0.5 * x * x + shift * x : (x + shift > 0 ? 0.5 * (x + shift) * (x + shift) : 0);
  }
  return force > 0 ? -force : 0;
}

}  // namespace

double restitution_of(double zeta, DampingPath path) {
  double x = 0, v = 1;
  double const dt = 2e-4;
  // Half a period is about 3 units; damping and clipping stretch it. A contact that no longer pushes leaves at v.
  for (int i = 0; i < 400000; ++i) {
    double const k1 = acceleration(x, v, zeta, path),
                 k2 = acceleration(x + 0.5 * dt * v, v + 0.5 * dt * k1, zeta, path);
    double const k3 = acceleration(x + 0.5 * dt * (v + 0.5 * dt * k1), v + 0.5 * dt * k2, zeta, path);
    double const k4 = acceleration(x + dt * (v + 0.5 * dt * k2), v + dt * k3, zeta, path);
    x += dt * (v + dt * (k1 + k2 + k3) / 6);
    v += dt * (k1 + 2 * k2 + 2 * k3 + k4) / 6;
    if (x <= 0 && v < 0) break;
  }
  return -v;
}

double damping_ratio_for(double restitution, DampingPath path) {
  if (!(restitution > 0 && restitution <= 1))
    throw std::invalid_argument("restitution " + std::to_string(restitution) + " is outside (0, 1]");
  if (restitution == 1) return 0;
  double low = 0, high = 8;
  if (restitution_of(high, path) > restitution)
    throw std::invalid_argument("restitution " + std::to_string(restitution) +
                                " is below what the damping law reaches");
  for (int i = 0; i < 50; ++i) {
    double const mid = 0.5 * (low + high);
    (restitution_of(mid, path) > restitution ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

}  // namespace scree
