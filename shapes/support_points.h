// support_points.h: extreme points of the surface phi = 0.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/zero_set.h"

namespace scree {

// `count` unit vectors, evenly spread (Fibonacci lattice turned by `twist` [rad]); deterministic.
std::vector<Vec3> quasi_uniform_directions(int count, double twist = 0);

// Index of the point with the largest direction . point, for each direction (-1 without points). Exact; ties go to the
// smaller index.
std::vector<int> extreme_points(std::vector<Vec3> const& point, std::vector<Vec3> const& direction);

// Climb from start[i] along the surface to where direction[i] . x is largest: steps along the tangential part of the
// direction, projected back onto phi = 0, kept only if they gain. `step` is the first step length [d], about the
// spacing of the points the starts come from; what is left is below step / 50, far below on smooth parts.
std::vector<Vec3> climb(PhiBatch const& phi, std::vector<Vec3> const& start, std::vector<Vec3> const& direction,
                        double step, int rounds = 24);

// Sharp corners are no vertices of a marched mesh. A vertex that is extreme in many of `directions` directions stands
// for one: it is moved to where it climbs along their mean, with that mean as its normal, and listed in set.corner.
void sharpen_corners(PhiBatch const& phi, ZeroSet& set, int directions = 3000);

}  // namespace scree
