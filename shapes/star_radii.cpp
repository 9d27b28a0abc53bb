// star_radii.cpp: see star_radii.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/star_radii.h"

#include <algorithm>

namespace scree {
namespace {

int constexpr samples_per_ray = 64;

}  // namespace

std::vector<double> star_radii(PhiBatch const& phi, std::vector<Vec3> const& direction, double reach) {
  std::size_t const n = direction.size();
  std::vector<Vec3> point(n * samples_per_ray);
  std::vector<double> value(point.size());
  for (std::size_t i = 0; i < n; ++i)
    for (int s = 0; s < samples_per_ray; ++s)
      point[i * samples_per_ray + s] = direction[i] * (reach * (s + 0.5) / samples_per_ray);
  phi(point, value, {});
  std::vector<double> low(n), high(n), at(n);
  for (std::size_t i = 0; i < n; ++i) {
    double const* const v = &value[i * samples_per_ray];
    int inside = 0;
    while (inside < samples_per_ray && v[inside] > 0) ++inside;
    bool const once = inside > 0 && inside < samples_per_ray &&
                      std::all_of(v + inside, v + samples_per_ray, [](double x) { return x <= 0; });
    if (!once) return {};
    low[i] = reach * (inside - 0.5) / samples_per_ray;
    high[i] = reach * (inside + 0.5) / samples_per_ray;
  }
  point.resize(n);
  value.resize(n);
  // 20 halvings of 1/64 of the radius leave 1e-8 d, below what float coordinates of the files hold.
  for (int halving = 0; halving < 20; ++halving) {
    for (std::size_t i = 0; i < n; ++i) point[i] = direction[i] * (at[i] = (low[i] + high[i]) / 2);
    phi(point, value, {});
    for (std::size_t i = 0; i < n; ++i) (value[i] > 0 ? low : high)[i] = at[i];
  }
  return at;
}

}  // namespace scree
