// support_points.cpp: see support_points.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/support_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

std::vector<Vec3> quasi_uniform_directions(int count, double twist) {
  std::vector<Vec3> direction(count);
  double constexpr golden_angle = std::numbers::pi * (3 - 2.2360679774997896);
  for (int i = 0; i < count; ++i) {
    double const z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), angle = golden_angle * i + twist;
    direction[i] = {r * std::cos(angle), r * std::sin(angle), z};
  }
  return direction;
}

std::vector<int> extreme_points(std::vector<Vec3> const& point, std::vector<Vec3> const& direction) {
  // Points far inside the bounding ball are never extreme; the loop is a plain scan over separate coordinates, which
  // the compiler turns into SIMD.
  int const n = static_cast<int>(point.size());
  std::vector<double> x(n), y(n), z(n), h(n);
  for (int i = 0; i < n; ++i) x[i] = point[i].x, y[i] = point[i].y, z[i] = point[i].z;
  std::vector<int> best(direction.size(), -1);
  for (std::size_t k = 0; k < direction.size(); ++k) {
    Vec3 const d = direction[k];
    for (int i = 0; i < n; ++i) h[i] = d.x * x[i] + d.y * y[i] + d.z * z[i];
    best[k] = n == 0 ? -1 : static_cast<int>(std::max_element(h.begin(), h.end()) - h.begin());
  }
  return best;
}

std::vector<Vec3> climb(PhiBatch const& phi, std::vector<Vec3> const& start, std::vector<Vec3> const& direction,
                        double step) {
  int constexpr rounds = 24;
  int const n = static_cast<int>(start.size());
  std::vector<Vec3> best = start, gradient(n), trial(n), trial_gradient(n);
  std::vector<double> length(n, step), left(n);
  if (n == 0) return best;
  project_to_surface(phi, best, gradient, step, 3);
  for (int round = 0; round < rounds; ++round) {
    for (int i = 0; i < n; ++i) {
      double const g2 = norm2(gradient[i]);
      Vec3 const tangential = g2 > 0 ? direction[i] - gradient[i] * (dot(direction[i], gradient[i]) / g2) : Vec3{};
      double const t = norm(tangential);
      // Near the summit the tangential part fades like the distance to it; the step does too.
      trial[i] = best[i] + (t > 1e-12 ? tangential * (length[i] / std::max(t, 0.02)) : Vec3{});
    }
    project_to_surface(phi, trial, trial_gradient, 4 * step, 3, left);
    for (int i = 0; i < n; ++i) {
      bool const on_surface = std::abs(left[i]) < 1e-3 * step * std::sqrt(norm2(trial_gradient[i]));
      if (on_surface && dot(direction[i], trial[i]) > dot(direction[i], best[i])) {
        best[i] = trial[i];
        gradient[i] = trial_gradient[i];
        length[i] = std::min(1.3 * length[i], 3 * step);
      } else {
        length[i] *= 0.4;
      }
    }
  }
  return best;
}

}  // namespace scree
