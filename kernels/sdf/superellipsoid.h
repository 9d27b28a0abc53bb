// superellipsoid.h: true distance to a superellipsoid (exponents 0.1..1.9, convex), in double.
// Outside, the nearest point comes from superellipsoid_foot.h. Inside, Newton on the surface: tangent-plane steps with
// the shape operator from differences of the normal, retracted by the gauge; works at sharp edges (small exponents) and
// pointed tips (large ones), where textbook parametrisations stall. phi to 1e-8 of the size; the gradient to 1e-5, but
// inside only to 1e-2 near the ridges of exponents above 1.5.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/vec.h"
#include "kernels/sdf/superellipsoid_foot.h"

namespace scree::detail {

// The gauge rho(s) is homogeneous of degree 1, and rho = 1 on the surface. All points in the octant x, y, z >= 0.
struct Superellipsoid {
  Vec3 a;
  double p, q;  // 2/ew, 2/ns

  SCREE_HD double gauge(Vec3 s) const {
    double const u = std::pow(s.x / a.x, p) + std::pow(s.y / a.y, p);
    return std::pow(std::pow(u, q / p) + std::pow(s.z / a.z, q), 1 / q);
  }
  SCREE_HD Vec3 onto_surface(Vec3 s) const {
    double constexpr least = 1e-30;  // keeps the point off 0, where no direction is left
    s = {s.x > 0 ? s.x : 0, s.y > 0 ? s.y : 0, s.z > 0 ? s.z : 0};
    // A gauge of points near the coordinate planes may underflow; the largest scaled coordinate bounds it from below.
    double const g = gauge(s);
    return s / (g > least ? g : least);
  }
  SCREE_HD Vec3 normal(Vec3 s) const {
    double const x = s.x / a.x, y = s.y / a.y, z = s.z / a.z;
    double const u = std::pow(x, p) + std::pow(y, p);
    double const f = u > 0 ? std::pow(u, q / p - 1) : 0;
    Vec3 const n{f * std::pow(x, p - 1) / a.x, f * std::pow(y, p - 1) / a.y, std::pow(z, q - 1) / a.z};
    return normalized(n);
  }
  SCREE_HD Vec3 at_angles(double eta, double omega) const {  // Barr 1981: eta = latitude, omega = longitude
    double const ew = 2 / p, ns = 2 / q;
    double const ce = std::pow(std::cos(eta), ns);
    return {a.x * ce * std::pow(std::cos(omega), ew), a.y * ce * std::pow(std::sin(omega), ew),
            a.z * std::pow(std::sin(eta), ns)};
  }
};

// Closest surface point among the samples of a coarse grid of angles and the radial projection: picks the basin.
SCREE_HD inline Vec3 superellipsoid_start(Superellipsoid const& shape, Vec3 y) {
  int constexpr samples = 7;
  double constexpr quarter_turn = 1.5707963267948966;
  Vec3 best = shape.onto_surface(y);
  double best2 = norm2(best - y);
  for (int i = 0; i < samples; ++i)
    for (int j = 0; j < samples; ++j) {
      Vec3 const s = shape.at_angles(quarter_turn * (i + 0.5) / samples, quarter_turn * (j + 0.5) / samples);
      if (norm2(s - y) < best2) best = s, best2 = norm2(s - y);
    }
  return best;
}

// One Newton step for min |s - y|^2 / 2 on the surface: (I + D kappa) t = tangential part of y - s, with D the
// distance (positive outside) and kappa the shape operator. Returns the tangential displacement.
SCREE_HD inline Vec3 superellipsoid_newton(Superellipsoid const& shape, Vec3 y, Vec3 s, Vec3 n, double damping) {
  Vec3 const gap = y - s;
  double const distance = dot(gap, n);
  Vec3 const t1 = normalized(std::fabs(n.x) < 0.6 ? cross(n, Vec3{1, 0, 0}) : cross(n, Vec3{0, 1, 0}));
  Vec3 const t2 = cross(n, t1);
  Vec3 const tangent[2] = {t1, t2};
  double kappa[2][2];
  for (int k = 0; k < 2; ++k) {
    double const h = 1e-5 * (shape.a.x + shape.a.y + shape.a.z);
    Vec3 const plus = shape.onto_surface(s + tangent[k] * h), minus = shape.onto_surface(s - tangent[k] * h);
    Vec3 const dn = shape.normal(plus) - shape.normal(minus);
    double const width = dot(plus - minus, tangent[k]);
    double const inverse = width > 0 ? 1 / width : 0;
    for (int l = 0; l < 2; ++l) kappa[l][k] = dot(dn, tangent[l]) * inverse;
  }
  double h11 = 1 + distance * kappa[0][0] + damping, h22 = 1 + distance * kappa[1][1] + damping;
  double h12 = distance * 0.5 * (kappa[0][1] + kappa[1][0]);
  double const g1 = dot(gap, t1), g2 = dot(gap, t2);
  // Shift an indefinite Hessian (a point near the medial axis) to the descent side.
  double const mean = 0.5 * (h11 + h22), spread = std::sqrt(0.25 * (h11 - h22) * (h11 - h22) + h12 * h12);
  double const lowest = mean - spread;
  if (lowest < 0.1) h11 += 0.1 - lowest, h22 += 0.1 - lowest;
  double const det = h11 * h22 - h12 * h12;
  return t1 * ((g1 * h22 - g2 * h12) / det) + t2 * ((g2 * h11 - g1 * h12) / det);
}

// Newton with damping from start s: the local minimum of |s - y|.
SCREE_HD inline Vec3 superellipsoid_descend(Superellipsoid const& shape, Vec3 y, Vec3 s) {
  double const size = shape.a.x + shape.a.y + shape.a.z;
  double distance2 = norm2(s - y), damping = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    Vec3 const step = superellipsoid_newton(shape, y, s, shape.normal(s), damping);
    bool const small = norm2(step) < 1e-20 * size * size;
    Vec3 const next = shape.onto_surface(s + step);
    double const next2 = norm2(next - y);
    if (next2 < distance2) {
      bool const done = small && distance2 - next2 < 1e-15 * size * size;
      s = next, distance2 = next2, damping *= 0.2;
      if (done) break;
    } else {
      damping = damping > 0 ? 6 * damping : 0.5;
      if (small || damping > 1e9) break;
    }
  }
  return s;
}

SCREE_HD inline double superellipsoid_distance(Vec3 a, double ns, double ew, Vec3 x, Vec3* gradient) {
  Superellipsoid const shape{a, 2 / ew, 2 / ns};
  double const size = a.x + a.y + a.z;
  Vec3 y{std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)};
  // Off the symmetry planes by 1e-12: pow(0, small) and the normal of a ridge are not defined on them.
  for (int i = 0; i < 3; ++i) y[i] = y[i] > 1e-12 * a[i] ? y[i] : 1e-12 * a[i];
  bool const inside = shape.gauge(y) < 1;
  Vec3 s = inside ? superellipsoid_descend(shape, y, superellipsoid_start(shape, y))
                  : shape.onto_surface(superellipsoid_foot(a, shape.p, shape.q, y));
  if (inside) {
    // Every face holds a minimum of its own: also descend from where the three axis directions leave the body.
    for (int k = 0; k < 3; ++k) {
      double low = 0, high = a[k];  // bisection on coordinate k
      Vec3 hit = y;
      for (int i = 0; i < 40; ++i) {
        hit[k] = 0.5 * (low + high);
        (shape.gauge(hit) < 1 ? low : high) = hit[k];
      }
      Vec3 const other = superellipsoid_descend(shape, y, shape.onto_surface(hit));
      if (norm2(other - y) < norm2(s - y)) s = other;
    }
  }
  double const distance = norm(s - y);
  Vec3 n = shape.normal(s);
  double const sign = dot(n, s - y) >= 0 ? 1 : -1;
  // On a ridge (exponent near 2) the normal turns within nanometres of s; the direction to s does not.
  if (distance > 1e-4 * size) n = (s - y) * (sign / distance);
  if (gradient) *gradient = {x.x < 0 ? n.x : -n.x, x.y < 0 ? n.y : -n.y, x.z < 0 ? n.z : -n.z};
  return sign * distance;
}

// Gradient of the dual gauge: where n . x is largest (n >= 0).
SCREE_HD inline Vec3 superellipsoid_support(Vec3 a, double ns, double ew, Vec3 n) {
  double const p = 2 / ew, q = 2 / ns, dp = p / (p - 1), dq = q / (q - 1);
  double const x = a.x * n.x, y = a.y * n.y, z = a.z * n.z;
  double const u = std::pow(x, dp) + std::pow(y, dp);
  double const h = std::pow(std::pow(u, dq / dp) + std::pow(z, dq), 1 / dq);
  double const f = u > 0 ? std::pow(h, 1 - dq) * std::pow(u, dq / dp - 1) : 0;
  return {a.x * f * std::pow(x, dp - 1), a.y * f * std::pow(y, dp - 1), a.z * std::pow(z / h, dq - 1)};
}

}  // namespace scree::detail
