// nearest_site.cpp: see nearest_site.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/nearest_site.h"

#include <algorithm>
#include <cmath>

namespace scree {

NearestSite::NearestSite(std::vector<Vec3> const& site, std::vector<Vec3> const& normal, double spacing) {
  int const n = static_cast<int>(site.size());
  if (n == 0) return;
  low_ = site[0];
  Vec3 high = low_;
  for (Vec3 p : site)
    for (int k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  double const longest = std::max({high.x - low_.x, high.y - low_.y, high.z - low_.z});
  cell_ = std::max({spacing, longest / 100, 1e-12});  // at most 101 cells along an edge
  inverse_cell_ = 1 / cell_;
  for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>((high[k] - low_[k]) * inverse_cell_) + 1;
  std::vector<int> cell(n);
  first_.assign(std::size_t(size_[0]) * size_[1] * size_[2] + 1, 0);
  for (int i = 0; i < n; ++i) {
    cell[i] = (cell_of(site[i].z, 2) * size_[1] + cell_of(site[i].y, 1)) * size_[0] + cell_of(site[i].x, 0);
    ++first_[cell[i] + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  site_.resize(n), normal_.resize(n), index_.resize(n);
  for (int i = 0; i < n; ++i) {  // in order of index: ties below go to the first
    int const place = next[cell[i]]++;
    site_[place] = site[i], normal_[place] = normal[i], index_[place] = i;
  }
}

int NearestSite::cell_of(double x, int axis) const {
  return std::clamp(static_cast<int>(std::floor((x - low_[axis]) * inverse_cell_)), 0, size_[axis] - 1);
}

int NearestSite::find(Vec3 x, Vec3 normal) const {
  int const facing = search(x, normal, -0.2);
  return facing >= 0 ? facing : search(x, normal, -2);
}

int NearestSite::search(Vec3 x, Vec3 normal, double least_cosine) const {
  if (site_.empty()) return -1;
  int const c[3] = {cell_of(x.x, 0), cell_of(x.y, 1), cell_of(x.z, 2)};
  double best2 = INFINITY;
  int best = -1;
  double border = cell_;  // distance from x to the nearest face of its own cell; 0 for points outside the grid
  for (int k = 0; k < 3; ++k) {
    double const inside = x[k] - low_[k] - c[k] * cell_;
    border = std::max(0.0, std::min({border, inside, cell_ - inside}));
  }
  int const rings = std::max({size_[0], size_[1], size_[2]});
  for (int r = 0; r < rings; ++r) {
    double const ring_distance = border + (r - 1) * cell_;
    if (r > 0 && best >= 0 && ring_distance * ring_distance > best2) break;
    for (int k = std::max(c[2] - r, 0); k <= std::min(c[2] + r, size_[2] - 1); ++k)
      for (int j = std::max(c[1] - r, 0); j <= std::min(c[1] + r, size_[1] - 1); ++j) {
        bool const whole_row = std::abs(k - c[2]) == r || std::abs(j - c[1]) == r;
        int const step = whole_row || r == 0 ? 1 : 2 * r;
        for (int i = c[0] - r; i <= c[0] + r; i += step) {
          if (i < 0 || i >= size_[0]) continue;
          int const cell = (k * size_[1] + j) * size_[0] + i;
          for (int s = first_[cell]; s < first_[cell + 1]; ++s) {
            double const d2 = norm2(site_[s] - x);
            if (d2 > best2 || dot(normal_[s], normal) < least_cosine) continue;
            if (d2 < best2 || index_[s] < best) best2 = d2, best = index_[s];
          }
        }
      }
  }
  return best;
}

}  // namespace scree
