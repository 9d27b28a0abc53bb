// harmonic_shape.cpp: see harmonic_shape.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/harmonic_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "kernels/sdf/harmonics.h"
#include "shapes/normalise.h"
#include "shapes/support_points.h"

namespace scree {

RadiusRange radius_range(Span<const double> coefficient) {
  // Four samples a half wave of the highest degree.
  int const samples = std::max(1000, 16 * coefficient.size());
  double const between = 0.6 * std::sqrt(4 * std::numbers::pi / samples);  // from a direction to the next sample
  RadiusRange range{1e300, 0, 0};
  for (Vec3 const n : quasi_uniform_directions(samples)) {
    Vec3 gradient;
    double const r = harmonic_radius(coefficient, n, &gradient), slope = norm(gradient);
    range.least = std::min(range.least, r - slope * between);
    range.largest = std::max(range.largest, r + slope * between);
    range.slope = std::max(range.slope, 1.02 * slope);
  }
  return range;
}

int add_harmonic_shape(Library& library, std::string const& name, std::vector<double> coefficient, int threads) {
  std::string const whose = "shape '" + name + "': ";
  if (harmonic_degree(static_cast<int>(coefficient.size())) < 0)
    throw std::invalid_argument(whose + std::to_string(coefficient.size()) +
                                " harmonic coefficients are not (degree + 1)^2");
  RadiusRange const range = radius_range(coefficient);
  if (!(range.least > 0) || !std::isfinite(range.largest))
    throw std::invalid_argument(whose + "the radius is not positive everywhere: the body is not star-shaped");
  Shape shape;
  shape.name = name;
  shape.kind = ShapeKind::harmonics;
  shape.data = static_cast<int>(library.harmonics.size());
  shape.certificate.source =
      "spherical harmonics of degree " + std::to_string(harmonic_degree(static_cast<int>(coefficient.size())));
  library.harmonics.push_back(std::move(coefficient));
  library.shape.push_back(shape);
  int const index = static_cast<int>(library.shape.size()) - 1;
  normalise_shape(library, index, 1.01 * range.largest, {.threads = threads});
  double const steepness = range.slope / range.least;  // a ratio: the same in any unit
  library.shape[index].lipschitz = std::sqrt(1 + steepness * steepness);
  return index;
}

}  // namespace scree
