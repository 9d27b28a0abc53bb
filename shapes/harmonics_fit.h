// harmonics_fit.h: the star-shaped body r(direction) of spherical harmonics that fits surface points best.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/vec.h"

namespace scree {

struct HarmonicsFit {
  std::vector<double> coefficient;  // (degree + 1)^2, convention of kernels/sdf/harmonics.h [unit of the points]
  double rms = 0;                   // residual of the radii [unit of the points]
  double largest = 0;               // largest |residual| [unit of the points]
};

// Least squares of |x| over the directions x / |x| (Householder QR with column pivoting), every point with the same
// weight: spread them evenly. Throws std::invalid_argument for a degree outside 0..20, fewer points than coefficients,
// a point at the origin, or directions that leave coefficients open.
HarmonicsFit fit_harmonics(std::vector<Vec3> const& surface_point, int degree);

}  // namespace scree
