// half_thickness.h: how deep the thin parts of a solid are: what a partner must never pass in one step.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/phi_batch.h"

namespace scree {

// From surface points inwards phi is climbed to the middle of the solid, where it stops rising; how high that is is
// half the local thickness as phi measures it. Returned is the value that a tenth of the points stay below: the
// thinnest part that is more than a tip. `normal`: outward units, for the first step. Climbs go in `step`s over twice
// `depth` at most. Unit: that of phi. 0 without points. `limit` of the points, evenly chosen, are followed.
double half_thickness(PhiBatch const& phi, std::vector<Vec3> const& point, std::vector<Vec3> const& normal, double step,
                      double depth, int limit = 40);

}  // namespace scree
