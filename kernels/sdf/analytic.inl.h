// analytic.inl.h: bodies of analytic.h, inline because both compilers need them inside kernels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sdf/analytic.h"
#include "kernels/sdf/superellipsoid.h"

namespace scree {
namespace detail {

SCREE_HD inline double clamp_min(double value, double low) { return value > low ? value : low; }
SCREE_HD inline double with_sign(double magnitude, double sign) { return sign < 0 ? -magnitude : magnitude; }
SCREE_HD inline Vec3 absolute(Vec3 v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
SCREE_HD inline Vec3 with_signs(Vec3 v, Vec3 sign) {
  return {with_sign(v.x, sign.x), with_sign(v.y, sign.y), with_sign(v.z, sign.z)};
}

SCREE_HD inline double sphere_distance(double radius, Vec3 x, Vec3* gradient) {
  double const r = norm(x);
  if (gradient) *gradient = r > 0 ? x * (-1 / r) : Vec3{0, 0, -1};  // the centre has no gradient: any unit vector
  return radius - r;
}

// Closest point of an ellipsoid by the secular equation |p(t)| = 1, p_i = a_i x_i / (t + a_i^2 - a_min^2) (Eberly,
// "Distance from a point to an ellipsoid"; t counted from the pole, so that nothing cancels near it), Newton on
// 1/|p| - 1, which is nearly linear and converges from the left (More, Sorensen 1983). A floor on |x_i| removes the
// degenerate interior cases at an error of 1e-13 of the size.
SCREE_HD inline double ellipsoid_distance(Vec3 a, Vec3 x, Vec3* gradient) {
  double const least = a.x < a.y ? (a.x < a.z ? a.x : a.z) : (a.y < a.z ? a.y : a.z);
  Vec3 y = absolute(x), pole;
  double t = 0;
  for (int i = 0; i < 3; ++i) {
    y[i] = clamp_min(y[i], 1e-13 * a[i]);
    pole[i] = (a[i] - least) * (a[i] + least);
    t = clamp_min(t, a[i] * y[i] - pole[i]);
  }
  Vec3 p;
  for (int iteration = 0; iteration < 60; ++iteration) {
    double length2 = 0, slope = 0;  // slope = -d(length2)/dt / 2
    for (int i = 0; i < 3; ++i) {
      double const s = 1 / (t + pole[i]);
      p[i] = a[i] * y[i] * s;
      length2 += p[i] * p[i];
      slope += p[i] * p[i] * s;
    }
    double const step = length2 / slope * (std::sqrt(length2) - 1);
    t += step;
    if (!(std::fabs(step) > 4e-16 * t)) break;
  }
  Vec3 const closest = multiply(a, p);
  Vec3 const n = normalized(divide(p, a));  // outward normal of x^2/a^2 + ... = 1 at `closest`
  if (gradient) *gradient = with_signs(-n, x);
  return dot(n, closest - y);
}

SCREE_HD inline double box_distance(Vec3 half, Vec3 x, Vec3* gradient) {
  Vec3 const q = absolute(x) - half;
  if (q.x <= 0 && q.y <= 0 && q.z <= 0) {
    int const k = q.x > q.y ? (q.x > q.z ? 0 : 2) : (q.y > q.z ? 1 : 2);
    if (gradient) {
      *gradient = {};
      (*gradient)[k] = x[k] < 0 ? 1 : -1;
    }
    return -q[k];
  }
  Vec3 const out{clamp_min(q.x, 0), clamp_min(q.y, 0), clamp_min(q.z, 0)};
  double const distance = norm(out);
  if (gradient) *gradient = with_signs(out * (-1 / distance), x);
  return -distance;
}

}  // namespace detail

SCREE_HD inline double signed_distance(AnalyticSdf const& shape, Vec3 x, Vec3* gradient) {
  switch (shape.kind) {
    case AnalyticKind::sphere:
      return detail::sphere_distance(shape.half_size.x, x, gradient);
    case AnalyticKind::ellipsoid:
      return detail::ellipsoid_distance(shape.half_size, x, gradient);
    case AnalyticKind::superellipsoid:
      return detail::superellipsoid_distance(shape.half_size, shape.exponent_ns, shape.exponent_ew, x, gradient);
    case AnalyticKind::box:
      return detail::box_distance(shape.half_size, x, gradient);
    case AnalyticKind::plane:
      if (gradient) *gradient = {0, 0, -1};
      return -x.z;
    case AnalyticKind::cylinder:
      return detail::cylinder_distance(shape.half_size, x, gradient);
    case AnalyticKind::bore:
      return detail::bore_distance(shape.half_size, x, gradient);
    case AnalyticKind::capsule:
      return detail::capsule_distance(shape.half_size, x, gradient);
    case AnalyticKind::funnel:
      return detail::funnel_distance(shape.half_size, shape.half_wall, x, gradient);
  }
  return -1e300;  // unreachable: every kind is listed; device code cannot throw
}

SCREE_HD inline double support(AnalyticSdf const& shape, Vec3 n, Vec3* point) {
  Vec3 const a = shape.half_size;
  Vec3 reached;
  switch (shape.kind) {
    case AnalyticKind::sphere:
      reached = n * a.x;
      break;
    case AnalyticKind::ellipsoid: {
      Vec3 const an = multiply(a, n);
      reached = multiply(a, an) / norm(an);
      break;
    }
    case AnalyticKind::superellipsoid:
      reached = detail::with_signs(
          detail::superellipsoid_support(a, shape.exponent_ns, shape.exponent_ew, detail::absolute(n)), n);
      break;
    case AnalyticKind::box:
      reached = detail::with_signs(a, n);
      break;
    case AnalyticKind::plane:
      return n.z > 0 ? 0 : 1e300;
    case AnalyticKind::bore:
      return 1e300;
    case AnalyticKind::cylinder:
      reached = detail::on_axis(n, {a.x, a.z});
      break;
    case AnalyticKind::capsule:
      reached = Vec3{0, 0, n.z < 0 ? -a.z : a.z} + n * a.x;
      break;
    case AnalyticKind::funnel: {
      Vec3 const low = detail::on_axis({n.x, n.y, -1}, {a.x, a.z}), high = detail::on_axis({n.x, n.y, 1}, {a.y, a.z});
      reached = (dot(n, low) > dot(n, high) ? low : high) + n * shape.half_wall;
      break;
    }
  }
  if (point) *point = reached;
  return dot(n, reached);
}

SCREE_HD inline Curvatures wall_curvatures(AnalyticSdf const& shape, Vec3 x) {
  Vec3 const a = shape.half_size;
  switch (shape.kind) {
    case AnalyticKind::bore:
      return {-1 / a.x, 0};
    case AnalyticKind::capsule:
      return {1 / a.x, std::fabs(x.z) > a.z ? 1 / a.x : 0};
    case AnalyticKind::funnel:
      return detail::funnel_curvatures(a, shape.half_wall, x);
    default:
      return {};
  }
}

}  // namespace scree
