// harmonics.h: real spherical harmonics, star-shaped radii r(direction) made of them, and phi(x) = r(x/|x|) - |x|.
// Polynomials of the unit direction throughout: nothing is singular at the poles. Double; phi > 0 inside.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"

namespace scree {

// Convention: orthonormal over the unit sphere, real, without the Condon-Shortley phase, z the polar axis. With P the
// associated Legendre functions normalised to that (theta from +z, psi from +x towards +y):
//   Y(l, 0) = P(l, 0)(cos theta),  Y(l, +m) = sqrt2 P(l, m) cos(m psi),  Y(l, -m) = sqrt2 P(l, m) sin(m psi),
// so Y(1, -1), Y(1, 0), Y(1, 1) = sqrt(3 / 4 pi) (y, z, x). Coefficients lie in the order of l^2 + l + m.
// Recurrence in l at fixed m after Holmes & Featherstone (2002), eq. 11; degrees to 40 lose no digits (tested to 20).
SCREE_HD inline int harmonic_count(int degree) { return (degree + 1) * (degree + 1); }
SCREE_HD inline int harmonic_index(int l, int m) { return l * l + l + m; }

// Degree of a coefficient array; -1: the count is not a square.
SCREE_HD inline int harmonic_degree(int count) {
  int degree = -1;
  while (harmonic_count(degree + 1) <= count) ++degree;
  return degree >= 0 && harmonic_count(degree) == count ? degree : -1;
}

namespace detail {

// Walks l = m, m + 1, ... at one order m: P(l, m) / sin(theta)^m (times sqrt2 for m > 0) and its derivative in z.
struct HarmonicColumn {
  int m, l;
  double value, slope;
  double value_before = 0, slope_before = 0;  // of l - 1
  double last_factor = 0;                     // a(l), which is 1 / b(l + 1)

  // `sectoral`: the value at l = m.
  SCREE_HD HarmonicColumn(int order, double sectoral) : m(order), l(order), value(sectoral), slope(0) {}

  SCREE_HD void next(double z) {
    ++l;
    double const a = std::sqrt((4.0 * l * l - 1) / (double(l) * l - double(m) * m));
    double const b = last_factor > 0 ? a / last_factor : 0;
    double const v = a * z * value - b * value_before, s = a * (value + z * slope) - b * slope_before;
    value_before = value, slope_before = slope, value = v, slope = s, last_factor = a;
  }
};

// Goes from order m to m + 1: sin^m cos(m psi) and sin^m sin(m psi) as polynomials of x and y, and the sectoral value.
struct HarmonicOrder {
  int m = 0;
  double cosine = 1, sine = 0;                // Re, Im of (x + iy)^m
  double cosine_before = 0, sine_before = 0;  // of m - 1
  double sectoral = 0.28209479177387814;      // 1 / sqrt(4 pi)

  SCREE_HD void next(Vec3 n) {
    ++m;
    cosine_before = cosine, sine_before = sine;
    cosine = n.x * cosine_before - n.y * sine_before;
    sine = n.x * sine_before + n.y * cosine_before;
    sectoral *= std::sqrt((m == 1 ? 2.0 : 1.0) * (2 * m + 1) / (2 * m));
  }
};

}  // namespace detail

// All Y(l, m) up to `degree` at the unit vector n, into y (harmonic_count(degree)).
SCREE_HD inline void harmonics(int degree, Vec3 n, Span<double> y) {
  detail::HarmonicOrder order;
  while (true) {
    detail::HarmonicColumn column(order.m, order.sectoral);
    while (true) {
      y[harmonic_index(column.l, order.m)] = column.value * order.cosine;
      if (order.m > 0) y[harmonic_index(column.l, -order.m)] = column.value * order.sine;
      if (column.l == degree) break;
      column.next(n.z);
    }
    if (order.m == degree) return;
    order.next(n);
  }
}

// r(n) = sum of c Y at the unit vector n; `gradient` (may be null): derivative of r(x/|x|) with respect to x at |x| =
// 1, which is tangential. A count that is not a square is cut to the degree below.
SCREE_HD inline double harmonic_radius(Span<const double> c, Vec3 n, Vec3* gradient) {
  int degree = 0;
  while (harmonic_count(degree + 1) <= c.size()) ++degree;
  double r = 0;
  Vec3 g{};
  detail::HarmonicOrder order;
  while (true) {
    detail::HarmonicColumn column(order.m, order.sectoral);
    double even = 0, odd = 0, even_slope = 0, odd_slope = 0;  // sums over l of the cosine and of the sine terms
    while (true) {
      double const ce = c[harmonic_index(column.l, order.m)], co = c[harmonic_index(column.l, -order.m)];
      even += ce * column.value, even_slope += ce * column.slope;
      odd += co * column.value, odd_slope += co * column.slope;
      if (column.l == degree) break;
      column.next(n.z);
    }
    r += even * order.cosine + odd * order.sine;
    if (gradient) {
      int const m = order.m;
      g.x += m * (even * order.cosine_before + odd * order.sine_before);
      g.y += m * (odd * order.cosine_before - even * order.sine_before);
      g.z += even_slope * order.cosine + odd_slope * order.sine;
    }
    if (order.m == degree) break;
    order.next(n);
  }
  if (gradient) *gradient = g - n * dot(g, n);
  return r;
}

// Radial field of the star-shaped body |x| <= r(x/|x|) and its exact gradient, whose length is at least 1:
// phi is the distance along the ray, not the shortest one. At the centre, where the field has no limit, phi is the mean
// radius and the gradient zero.
SCREE_HD inline double radial_distance(Span<const double> c, Vec3 x, Vec3* gradient) {
  double const length = norm(x);
  if (!(length > 1e-12)) {
    if (gradient) *gradient = {};
    return c[0] * 0.28209479177387814;
  }
  Vec3 const n = x / length;
  Vec3 slope;
  double const r = harmonic_radius(c, n, gradient ? &slope : nullptr);
  if (gradient) *gradient = slope / length - n;
  return r - length;
}

}  // namespace scree
