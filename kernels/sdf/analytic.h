// analytic.h: true signed distance and gradient of sphere, ellipsoid, superellipsoid, box and plane, in double.
// phi > 0 inside; the gradient points inwards and has length 1 where it exists.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/config.h"
#include "kernels/base/vec.h"

namespace scree {

enum class AnalyticKind { sphere, ellipsoid, superellipsoid, box, plane };

// Centred at the origin, axes along x, y, z.
struct AnalyticSdf {
  AnalyticKind kind = AnalyticKind::sphere;
  Vec3 half_size{0.5, 0.5, 0.5};  // semi-axes; sphere: radius in x; plane: the solid is z < 0, unused
  double exponent_ns = 1;  // superellipsoid only, 0.1..1.9: |z/c|^(2/ns) + (|x/a|^(2/ew) + |y/b|^(2/ew))^(ew/ns) = 1
  double exponent_ew = 1;
};

// phi at x [same unit as half_size]; `gradient` may be null.
SCREE_HD double signed_distance(AnalyticSdf const& shape, Vec3 x, Vec3* gradient);

// Support function h(n) = max over the solid of n . x for a unit vector n (not for a plane), and where it is reached.
SCREE_HD double support(AnalyticSdf const& shape, Vec3 n, Vec3* point);

}  // namespace scree

#include "kernels/sdf/analytic.inl.h"
