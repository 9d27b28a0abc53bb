// half_thickness.cpp: see half_thickness.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/half_thickness.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

double constexpr thin_share = 0.1;  // of the points: tips are thin everywhere

}  // namespace

double half_thickness(PhiBatch const& phi, std::vector<Vec3> const& point, std::vector<Vec3> const& normal, double step,
                      double depth, int limit) {
  int const n = std::min<int>(limit, static_cast<int>(point.size()));
  if (n == 0) return 0;
  std::vector<Vec3> at(n), slope(n);
  std::vector<double> value(n), highest(n, 0);
  for (int i = 0; i < n; ++i) {
    std::size_t const k = i * point.size() / n;
    at[i] = point[k] - normal[k] * step;
  }
  // On a ridge between two faces the climb goes from one side to the other, half a step higher each time.
  int const steps = static_cast<int>(std::ceil(2 * depth / step));
  for (int s = 0; s < steps; ++s) {
    phi(at, value, slope);
    for (int i = 0; i < n; ++i) {
      highest[i] = std::max(highest[i], value[i]);
      if (norm(slope[i]) > 0) at[i] += normalized(slope[i]) * step;
    }
  }
  auto const thin = highest.begin() + static_cast<int>(thin_share * n);
  std::nth_element(highest.begin(), thin, highest.end());
  return *thin;
}

}  // namespace scree
