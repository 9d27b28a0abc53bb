// measure_surface.cpp: see measure_surface.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace scree {
namespace {

using Cell = std::pair<int, int>;

std::map<Cell, SurfacePoint> highest(std::vector<SurfacePoint> const& points, auto const& cell_of) {
  std::map<Cell, SurfacePoint> top;
  for (SurfacePoint const& p : points) {
    auto const [at, fresh] = top.try_emplace(cell_of(p), p);
    if (!fresh && p.height > at->second.height) at->second = p;
  }
  return top;
}

int bin_of(double x, double size) { return static_cast<int>(std::floor(x / size)); }

}  // namespace

std::vector<SurfacePoint> top_layer(std::vector<SurfacePoint> const& points, double size) {
  std::vector<SurfacePoint> out;
  for (auto const& [cell, p] : highest(points, [&](SurfacePoint const& q) {
         return Cell{bin_of(q.along, size), bin_of(q.across, size)};
       }))
    out.push_back(p);
  return out;
}

LineFit fit_line(std::vector<SurfacePoint> const& points) {
  LineFit fit;
  fit.points = static_cast<int>(points.size());
  if (points.size() < 2) return fit;
  double x = 0, y = 0, xx = 0, xy = 0, square = 0;
  for (SurfacePoint const& p : points) x += p.along, y += p.height;
  x /= fit.points, y /= fit.points;
  for (SurfacePoint const& p : points) xx += (p.along - x) * (p.along - x), xy += (p.along - x) * (p.height - y);
  if (!(xx > 0)) return fit;
  fit.slope = xy / xx;
  fit.offset = y - fit.slope * x;
  for (SurfacePoint const& p : points) square += std::pow(p.height - fit.offset - fit.slope * p.along, 2);
  fit.rms = std::sqrt(square / fit.points);
  return fit;
}

LineFit fit_surface(std::vector<SurfacePoint> const& points, double reach) {
  LineFit const first = fit_line(points);
  std::vector<SurfacePoint> near;
  for (SurfacePoint const& p : points)
    if (std::abs(p.height - first.offset - first.slope * p.along) <= reach * std::hypot(1, first.slope))
      near.push_back(p);
  return near.size() == points.size() ? first : fit_line(near);
}

HeapFit fit_heap(std::vector<SurfacePoint> const& points, bool radial, double bin, double base, double low,
                 double high) {
  std::vector<SurfacePoint> seen = points;
  for (SurfacePoint& p : seen) {
    if (!radial && p.along < 0) p.across += 1e6 * bin;  // the other flank has cells of its own
    p.along = std::abs(p.along);
  }
  auto const tops = highest(seen, [&](SurfacePoint const& p) {
    int const ring = bin_of(p.along, bin);
    // Arcs about one bin long.
    double const arc =
        radial ? 2 * std::numbers::pi / std::max(1.0, std::round(2 * std::numbers::pi * (ring + 0.5))) : bin;
    return Cell{ring, bin_of(p.across, arc)};
  });
  std::map<int, std::vector<SurfacePoint>> ring;
  for (auto const& [cell, p] : tops) ring[cell.first].push_back(p);
  auto const mean = [](std::vector<SurfacePoint> const& of) {
    double sum = 0;
    for (SurfacePoint const& p : of) sum += p.height;
    return sum / static_cast<double>(of.size());
  };
  HeapFit fit;
  if (ring.empty()) return fit;
  fit.top = -std::numeric_limits<double>::infinity();
  for (auto const& [k, of] : ring) fit.top = std::max(fit.top, mean(of));
  std::vector<SurfacePoint> flank;
  for (auto const& [k, of] : ring)
    if (double const share = (mean(of) - base) / (fit.top - base); share >= low && share <= high)
      flank.insert(flank.end(), of.begin(), of.end());
  fit.line = fit_line(flank);
  return fit;
}

}  // namespace scree
