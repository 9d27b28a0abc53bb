// solid_check.h: what phi alone tells of a body: its slope near the surface and how much of its interior falls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/phi_batch.h"
#include "shapes/zero_set.h"

namespace scree {

struct SolidCheck {
  double gradient_p1 = 0, gradient_p5 = 0, gradient_p95 = 0,
         gradient_p99 = 0;  // |grad phi| within 0.05 d of the surface
  double falling = 0;       // share of the interior deeper than 0.05 d at which phi falls away from the nearest surface
};

// `points` quasi-random points each: vertices of the zero set moved along their normals by up to 0.05 d, and points of
// the ball of `radius` about the origin. The body's own medial axis falls too, so that a small share is no defect.
// Deterministic. `set` has at least one vertex.
SolidCheck check_solid(PhiBatch const& phi, ZeroSet const& set, double radius, int points);

}  // namespace scree
