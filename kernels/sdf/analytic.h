// analytic.h: true signed distance and gradient of grains and walls with a formula, in double.
// phi > 0 inside; the gradient points inwards and has length 1 where it exists.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/config.h"
#include "kernels/base/vec.h"
#include "kernels/sdf/revolution.h"

namespace scree {

// The second row are walls: half space, solid cylinder, everything but a cylinder's inside, capsule, and the shell of
// a cone.
enum class AnalyticKind { sphere, ellipsoid, superellipsoid, box, plane, cylinder, bore, capsule, funnel };

// Centred at the origin, axes along x, y, z; bodies of revolution about z.
struct AnalyticSdf {
  AnalyticKind kind = AnalyticKind::sphere;
  // Semi-axes; sphere: radius in x; plane: unused, the solid is z < 0; cylinder: radius in x, half length in z; bore:
  // radius in x, endless; capsule: radius in x, half length of its axis in z; funnel: radius of the middle of its wall
  // at z = -half_size.z in x, at z = +half_size.z in y. half_wall on both sides of it, round rims.
  Vec3 half_size{0.5, 0.5, 0.5};
  double exponent_ns = 1;  // superellipsoid only, 0.1..1.9: |z/c|^(2/ns) + (|x/a|^(2/ew) + |y/b|^(2/ew))^(ew/ns) = 1
  double exponent_ew = 1;
  double half_wall = 0;  // funnel: half the thickness of its wall
};

// phi at x [same unit as half_size]; `gradient` may be null.
SCREE_HD double signed_distance(AnalyticSdf const& shape, Vec3 x, Vec3* gradient);

// Curvatures of the surface of a smooth wall (plane, bore, capsule, funnel) at its point closest to x; 0 for others.
SCREE_HD Curvatures wall_curvatures(AnalyticSdf const& shape, Vec3 x);

// Support function h(n) = max over the solid of n . x for a unit vector n (1e300: unbounded), and where it is reached.
SCREE_HD double support(AnalyticSdf const& shape, Vec3 n, Vec3* point);

}  // namespace scree

#include "kernels/sdf/analytic.inl.h"
