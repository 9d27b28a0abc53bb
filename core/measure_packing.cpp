// measure_packing.cpp: see measure_packing.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/measure_region.h"
#include "shapes/phi_batch.h"

namespace scree {
namespace {

// Radical inverse: digit k of n after the point.
double halton(int n, int base) {
  double value = 0, digit = 1;
  for (; n > 0; n /= base) value += (digit /= base) * (n % base);
  return value;
}

std::vector<Vec3> const& points_of(MeasureView const& view, int shape) {
  auto [at, fresh] = view.cache.inside.try_emplace({shape, view.measure.points});
  if (fresh) at->second = points_inside(view.scene.library, view.scene.template_shape(shape), view.measure.points);
  return at->second;
}

struct Filled {
  std::vector<double> volume, variance;  // of each slice [m3], [m6]

  void add(int slice, double v) {
    if (slice >= 0 && slice < static_cast<int>(volume.size())) volume[slice] += v;
  }
};

int slice_of(MeasureRegion const& region, Vec3 x, int slices) {
  return std::min(slices - 1, static_cast<int>(std::floor(region.along(x) * slices)));
}

// Points of grain i that lie in each slice.
void add_cut_grain(MeasureView const& view, MeasureRegion const& region, int i, double grain, Filled& filled) {
  std::vector<Vec3> const& points = points_of(view, view.scene.shape_of[i]);
  if (points.empty()) return;
  int const slices = static_cast<int>(filled.volume.size());
  std::vector<int> hits(slices, 0);
  Mat3 const rotation = to_matrix(view.state.orientation[i]);
  for (Vec3 const p : points) {
    Vec3 const x = view.state.position[i] + rotation * (p * view.scene.diameter[i]);
    if (region.contains(x)) ++hits[std::max(0, slice_of(region, x, slices))];
  }
  double const n = static_cast<double>(points.size());
  for (int s = 0; s < slices; ++s) {
    double const share = hits[s] / n;
    filled.volume[s] += grain * share;
    filled.variance[s] += grain * grain * share * (1 - share) / n;
  }
}

}  // namespace

std::vector<Vec3> points_inside(Library const& library, Shape const& shape, int count) {
  PhiBatch const phi = surface_phi(library, shape);
  double const r = shape.bounding_radius;
  std::vector<Vec3> out, tried(1024);
  std::vector<double> value(tried.size());
  for (int n = 1; n < 64 * count && static_cast<int>(out.size()) < count; n += static_cast<int>(tried.size())) {
    for (std::size_t k = 0; k < tried.size(); ++k) {
      int const at = n + static_cast<int>(k);
      tried[k] = Vec3{halton(at, 2), halton(at, 3), halton(at, 5)} * (2 * r) - Vec3{r, r, r};
    }
    phi(tried, value, {});
    for (std::size_t k = 0; k < tried.size() && static_cast<int>(out.size()) < count; ++k)
      if (value[k] > 0 && norm(tried[k]) <= r) out.push_back(tried[k]);
  }
  return out;
}

std::vector<Quantity> packing_quantities(MeasureView const& view) {
  std::vector<Quantity> out{{"fraction", "-"}, {"error", "-"}};
  for (int s = 0; s < view.measure.slices; ++s) out.push_back({fmt::format("slice_{}", s), "-"});
  return out;
}

Values sample_packing(MeasureView const& view, Memory&) {
  MeasureRegion const region(view.measure);
  int const slices = std::max(1, view.measure.slices);
  Filled filled{std::vector<double>(slices, 0), std::vector<double>(slices, 0)};
  for (int i = 0; i < view.scene.bodies(); ++i) {
    if (!view.state.is_active(i)) continue;
    double const d = view.scene.diameter[i], grain = std::numbers::pi / 6 * d * d * d;
    double const radius = view.scene.shape[view.scene.shape_of[i]].bounding_radius * d;
    Vec3 const x = view.state.position[i];
    MeasureRegion::Relation const relation = region.relation(x, radius);
    if (relation == MeasureRegion::Relation::outside) continue;
    double const at = region.along(x) * slices, reach = radius / region.length() * slices;
    bool const in_one = std::floor(at - reach) == std::floor(at + reach);
    if (relation == MeasureRegion::Relation::inside && (slices == 1 || in_one))
      filled.add(slices == 1 ? 0 : slice_of(region, x, slices), grain);
    else
      add_cut_grain(view, region, i, grain, filled);
  }
  double volume = 0, variance = 0;
  for (int s = 0; s < slices; ++s) volume += filled.volume[s], variance += filled.variance[s];
  double const place = region.volume() * view.c.replicas;  // every replica has the region to itself
  Values out{volume / place, std::sqrt(variance) / place};
  for (int s = 0; s < view.measure.slices; ++s) out.push_back(filled.volume[s] * slices / place);
  return out;
}

}  // namespace scree
