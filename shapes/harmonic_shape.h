// harmonic_shape.h: a star-shaped body from the harmonic coefficients of its radius, as a shape of a library.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/shape.h"

namespace scree {

// Least and largest radius and the steepest tangential slope |grad_s r| at |x| = 1, over directions so dense that what
// lies between them adds less than 2 % (the margins are included). Unit: that of the coefficients.
struct RadiusRange {
  double least = 0, largest = 0, slope = 0;
};
RadiusRange radius_range(Span<const double> coefficient);

// Append the body |x| <= r(x/|x|) to the library, normalised (volume pi/6, centroid and principal axes through the
// query transform) with mass, bounds and Lipschitz bound sqrt(1 + (slope / least radius)^2); `coefficient` in the order
// and convention of kernels/sdf/harmonics.h, any unit. Returns the shape's index. Throws std::invalid_argument for a
// count that is not (degree + 1)^2 and for a radius that is not positive everywhere.
int add_harmonic_shape(Library& library, std::string const& name, std::vector<double> coefficient, int threads = 1);

}  // namespace scree
