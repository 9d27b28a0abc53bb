// solid_check.cpp: see solid_check.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/solid_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "shapes/nearest_site.h"

namespace scree {
namespace {

double constexpr band = 0.05;  // where contacts are expected [d]

// Term i of the additive recurrence of Roberts (2018) in three dimensions, in [0, 1): alpha_k = g^-(k+1), g^4 = g + 1.
double recurrence(int i, int k) {
  double constexpr alpha[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  double const x = (i + 1) * alpha[k];
  return x - std::floor(x);
}

}  // namespace

SolidCheck check_solid(PhiBatch const& phi, ZeroSet const& set, double radius, int points) {
  SolidCheck result;
  std::vector<Vec3> point, gradient(points);
  std::vector<double> value(points), slope;
  auto const vertices = static_cast<double>(set.mesh.vertex.size());
  for (int i = 0; i < points; ++i) {
    auto const v = static_cast<std::size_t>(recurrence(i, 0) * vertices);
    point.push_back(set.mesh.vertex[v] + set.normal[v] * (band * (2 * recurrence(i, 1) - 1)));
  }
  phi(point, value, gradient);
  for (Vec3 const& g : gradient) slope.push_back(norm(g));
  std::sort(slope.begin(), slope.end());
  auto const percentile = [&](double share) { return slope[static_cast<std::size_t>(share * (points - 1))]; };
  result.gradient_p1 = percentile(0.01), result.gradient_p5 = percentile(0.05);
  result.gradient_p95 = percentile(0.95), result.gradient_p99 = percentile(0.99);

  point.clear();
  for (int i = 0; static_cast<int>(point.size()) < points; ++i) {
    Vec3 const x = Vec3{2 * recurrence(i, 0) - 1, 2 * recurrence(i, 1) - 1, 2 * recurrence(i, 2) - 1} * radius;
    if (norm(x) <= radius) point.push_back(x);
  }
  phi(point, value, gradient);
  NearestSite const nearest(set.mesh.vertex, set.normal, set.cell);
  int deep = 0, falling = 0;
  for (int i = 0; i < points; ++i) {
    if (!(value[i] > 0)) continue;
    Vec3 const inwards = point[i] - set.mesh.vertex[nearest.find(point[i], {})];
    if (norm(inwards) < band) continue;
    ++deep;
    falling += dot(gradient[i], inwards) < 0;
  }
  result.falling = deep > 0 ? static_cast<double>(falling) / deep : 0;  // nothing lies that deep in a thin body
  return result;
}

}  // namespace scree
