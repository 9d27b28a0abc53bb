// support_points.cpp: see support_points.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/support_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shapes/point_blocks.h"

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
  PointBlocks const blocks = make_point_blocks(point, 32);
  int const n_blocks = static_cast<int>(blocks.centre.size());
  std::vector<int> extreme(direction.size(), -1);
  std::vector<double> centre_height(n_blocks);
  for (std::size_t k = 0; k < direction.size(); ++k) {
    Vec3 const d = direction[k];
    double best = -INFINITY;
    int promising = 0;  // the block whose sphere reaches farthest is looked at first: it settles most others
    for (int b = 0; b < n_blocks; ++b) {
      centre_height[b] = dot(d, blocks.centre[b]) + blocks.radius[b];
      if (centre_height[b] > centre_height[promising]) promising = b;
    }
    auto const scan = [&](int b) {
      for (int i = blocks.first[b]; i < blocks.first[b + 1]; ++i) {
        int const p = blocks.order[i];
        double const h = dot(d, point[p]);
        if (h > best || (h == best && p < extreme[k])) best = h, extreme[k] = p;
      }
    };
    if (n_blocks > 0) scan(promising);
    for (int b = 0; b < n_blocks; ++b)
      if (b != promising && centre_height[b] >= best) scan(b);
  }
  return extreme;
}

std::vector<Vec3> climb(PhiBatch const& phi, std::vector<Vec3> const& start, std::vector<Vec3> const& direction,
                        double step, int rounds) {
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

void sharpen_corners(PhiBatch const& phi, ZeroSet& set, int directions) {
  int constexpr many = 5;  // of 3,000 directions: the normals at the vertex span more than a tenth of a radian
  std::vector<Vec3> const direction = quasi_uniform_directions(directions);
  std::vector<int> const top = extreme_points(set.mesh.vertex, direction);
  std::vector<Vec3> sum(set.mesh.vertex.size());
  std::vector<int> count(set.mesh.vertex.size(), 0);
  for (std::size_t k = 0; k < direction.size(); ++k) sum[top[k]] += direction[k], ++count[top[k]];
  std::vector<Vec3> start, mean;
  set.corner.clear();
  for (std::size_t v = 0; v < count.size(); ++v) {
    if (count[v] < many) continue;
    set.corner.push_back(static_cast<int>(v));
    start.push_back(set.mesh.vertex[v]);
    mean.push_back(normalized(sum[v]));
  }
  std::vector<Vec3> const summit = climb(phi, start, mean, set.cell);
  for (std::size_t i = 0; i < set.corner.size(); ++i) {
    set.mesh.vertex[set.corner[i]] = summit[i];
    set.normal[set.corner[i]] = mean[i];
  }
}

}  // namespace scree
