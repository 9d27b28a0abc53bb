// revolution.h: signed distances of bodies of revolution about z: cylinder, bore, capsule and funnel; see analytic.h.
// The closest point lies in the half plane (r, z) through the point, so each is a plane problem.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/config.h"
#include "kernels/base/vec.h"

namespace scree {

// Principal curvatures of a surface, positive where the solid is convex [1 / unit].
struct Curvatures {
  double first = 0, second = 0;
};

namespace detail {

struct Meridian {  // a point or a direction in the half plane through a point
  double r, z;
};

// Direction of r in the world; on the axis any.
SCREE_HD inline Vec3 outwards(Vec3 x) {
  double const r = std::sqrt(x.x * x.x + x.y * x.y);
  return r > 0 ? Vec3{x.x / r, x.y / r, 0} : Vec3{1, 0, 0};
}
SCREE_HD inline double radius_of(Vec3 x) { return std::sqrt(x.x * x.x + x.y * x.y); }

// The point of the circle or the side {r, z} that reaches furthest along n.
SCREE_HD inline Vec3 on_axis(Vec3 n, Meridian m) {
  Vec3 const out = outwards(n);
  return {out.x * m.r, out.y * m.r, n.z < 0 ? -m.z : m.z};
}

SCREE_HD inline void set_gradient(Vec3* gradient, Vec3 x, Meridian g) {
  if (!gradient) return;
  Vec3 const out = outwards(x);
  *gradient = {out.x * g.r, out.y * g.r, g.z};
}

SCREE_HD inline double cylinder_distance(Vec3 size, Vec3 x, Vec3* gradient) {
  double const side = x.z < 0 ? -1 : 1;
  double const out_r = radius_of(x) - size.x, out_z = std::fabs(x.z) - size.z;
  if (out_r <= 0 && out_z <= 0) {
    bool const mantle = out_r > out_z;
    set_gradient(gradient, x, mantle ? Meridian{-1, 0} : Meridian{0, -side});
    return mantle ? -out_r : -out_z;
  }
  double const r = out_r > 0 ? out_r : 0, z = out_z > 0 ? out_z : 0;
  double const distance = std::sqrt(r * r + z * z);
  set_gradient(gradient, x, {-r / distance, -side * z / distance});
  return -distance;
}

// Everything outside an endless cylinder.
SCREE_HD inline double bore_distance(Vec3 size, Vec3 x, Vec3* gradient) {
  set_gradient(gradient, x, {1, 0});
  return radius_of(x) - size.x;
}

SCREE_HD inline double capsule_distance(Vec3 size, Vec3 x, Vec3* gradient) {
  double const z = x.z > size.z ? x.z - size.z : (x.z < -size.z ? x.z + size.z : 0);
  double const r = radius_of(x), distance = std::sqrt(r * r + z * z);
  set_gradient(gradient, x, distance > 0 ? Meridian{-r / distance, -z / distance} : Meridian{-1, 0});
  return size.x - distance;
}

// From the closest point of the wall's middle line to x: its length, and where along the line (0: low end, 1: high).
struct FromMiddle {
  Meridian gap;
  double distance, along;
};
SCREE_HD inline FromMiddle from_middle(Vec3 size, Vec3 x) {
  Meridian const line{size.y - size.x, 2 * size.z};
  double const r = radius_of(x) - size.x, z = x.z + size.z;
  double t = (r * line.r + z * line.z) / (line.r * line.r + line.z * line.z);
  t = t < 0 ? 0 : (t > 1 ? 1 : t);
  Meridian const gap{r - t * line.r, z - t * line.z};
  return {gap, std::sqrt(gap.r * gap.r + gap.z * gap.z), t};
}

SCREE_HD inline double funnel_distance(Vec3 size, double half_wall, Vec3 x, Vec3* gradient) {
  FromMiddle const f = from_middle(size, x);
  if (f.distance > 0) {
    set_gradient(gradient, x, {-f.gap.r / f.distance, -f.gap.z / f.distance});
  } else {  // in the middle of the wall: towards either side is as far
    double const length = std::sqrt((size.y - size.x) * (size.y - size.x) + 4 * size.z * size.z);
    set_gradient(gradient, x, {-2 * size.z / length, (size.y - size.x) / length});
  }
  return half_wall - f.distance;
}

SCREE_HD inline Curvatures funnel_curvatures(Vec3 size, double half_wall, Vec3 x) {
  FromMiddle const f = from_middle(size, x);
  if (!(f.distance > 0)) return {};
  Meridian const n{f.gap.r / f.distance, f.gap.z / f.distance};  // outward normal
  double const r = size.x + f.along * (size.y - size.x) + half_wall * n.r;
  bool const rim = f.along <= 0 || f.along >= 1;
  return {rim ? 1 / half_wall : 0, r > 0 ? n.r / r : 0};
}

}  // namespace detail
}  // namespace scree
