// superellipsoid_foot.h: the point of a superellipsoid nearest to a point outside, by root finding in one unknown.
// At the foot s of y the gap y - s is a multiple of the gradient of G(s) = ((x/a)^p + (y/b)^p)^(q/p) + (z/c)^q. For a
// given multiple each coordinate follows from an equation of its own, so that G = 1 is one equation in one unknown. The
// body is convex: there is one foot, and no start, ridge or tip to stall at.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/vec.h"

namespace scree::detail {

// The x >= 0 with alpha x + m x^e = beta; alpha > 0, m >= 0, e > 0, beta >= 0. In x where e >= 1, in w = x^e where
// e < 1, the left side is convex and rises: Newton from above descends onto the root and cannot pass it.
SCREE_HD inline double sum_of_powers_root(double alpha, double m, double e, double beta) {
  if (!(beta > 0)) return 0;
  bool const in_x = e >= 1;
  double const linear = in_x ? alpha : m, curved = in_x ? m : alpha, power = in_x ? e : 1 / e;
  double const from_linear = beta / linear, from_curved = std::pow(beta / curved, 1 / power);
  double v = from_linear < from_curved ? from_linear : from_curved;
  int constexpr most = 60;  // the start is at most twice the left side too high: about 8 do
  for (int i = 0; i < most; ++i) {
    double const raised = curved * std::pow(v, power);
    double const next = v - (linear * v + raised - beta) / (linear + power * raised / v);
    if (!(next < v * (1 - 1e-15)) || !(next > 0)) break;
    v = next;
  }
  return in_x ? v : std::pow(v, power);
}

// Scaled coordinates of the foot's candidate for one multiple m = exp(t), and the logarithm of its gauge: positive
// while the candidate is still outside.
struct SuperellipsoidCandidate {
  Vec3 scaled;
  double log_gauge;
};
SCREE_HD inline SuperellipsoidCandidate superellipsoid_candidate(Vec3 a, double p, double q, Vec3 y, double t) {
  double const m = std::exp(t);
  double const u = sum_of_powers_root(a.x * a.x, m, p - 1, a.x * y.x);
  double const v = sum_of_powers_root(a.y * a.y, m, p - 1, a.y * y.y);
  double const log_plane = std::log(std::pow(u, p) + std::pow(v, p)) / p;  // of the gauge in the x, y plane
  double const w = sum_of_powers_root(a.z * a.z, std::exp(t + (p - q) * log_plane), q - 1, a.z * y.z);
  return {{u, v, w}, std::log(std::exp(q * log_plane) + std::pow(w, q)) / q};
}

// Nearest point of the surface to y, in the octant x, y, z > 0 and outside (gauge >= 1). p = 2 / ew, q = 2 / ns > 1.
// To 1e-12 of the size; about 15 candidates.
SCREE_HD inline Vec3 superellipsoid_foot(Vec3 a, double p, double q, Vec3 y) {
  auto const candidate = [&](double t) { return superellipsoid_candidate(a, p, q, y, t); };
  // The gauge of the candidate falls with t. A bracket, from a first guess by the radial distance.
  double const size = a.x + a.y + a.z, excess = candidate(-700).log_gauge;
  double low = std::log(size * size * (excess > 1e-16 ? excess : 1e-16)), high = low, step = 1;
  SuperellipsoidCandidate c = candidate(low);
  double f_low = c.log_gauge, f_high = f_low;
  int constexpr most = 200;
  if (f_low > 0) {
    for (int i = 0; i < most && f_high > 0; ++i, step *= 2)
      low = high, f_low = f_high, high += step, f_high = candidate(high).log_gauge;
  } else {
    for (int i = 0; i < most && f_low < 0 && low > -700; ++i, step *= 2)
      high = low, f_high = f_low, low = low - step > -700 ? low - step : -700, f_low = candidate(low).log_gauge;
  }
  // Regula falsi, the end that stays twice halved (Dowell, Jarratt 1971, the Illinois rule).
  int side = 0;
  for (int i = 0; i < most && high - low > 1e-13 * (1 + std::fabs(low)); ++i) {
    double t = low + (high - low) * (f_low / (f_low - f_high));
    if (!(t > low && t < high)) t = 0.5 * (low + high);
    c = candidate(t);
    if (std::fabs(c.log_gauge) < 1e-15) break;
    if (c.log_gauge > 0) {
      low = t, f_low = c.log_gauge;
      if (side == 1) f_high *= 0.5;
      side = 1;
    } else {
      high = t, f_high = c.log_gauge;
      if (side == -1) f_low *= 0.5;
      side = -1;
    }
  }
  return {a.x * c.scaled.x, a.y * c.scaled.y, a.z * c.scaled.z};
}

}  // namespace scree::detail
