// measure_angles.cpp: see measure_angles.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/measure_contacts.h"
#include "core/measure_region.h"
#include "core/measure_surface.h"
#include "core/measure_walls.h"
#include "core/measure_worlds.h"

namespace scree {
namespace {

double constexpr degrees = 180 / std::numbers::pi;
double constexpr nothing = std::numeric_limits<double>::quiet_NaN();
double constexpr flight = 1.5;  // bins off the surface: in flight

double bin_of(MeasureView const& view) { return view.measure.bin.value_or(largest_diameter(view.scene)); }

// Grains that contacts connect to a wall, by union of sets: what lies, not what meets in flight.
std::vector<char> resting(MeasureView const& view) {
  int const n = view.scene.bodies();
  std::vector<int> parent(n + 1);  // n: the walls
  std::iota(parent.begin(), parent.end(), 0);
  auto const root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t k = 0; k < view.work.pair.size(); ++k) {
    if (!(norm2(force_on_a(view.work.result[k])) > 0)) continue;
    Pair const p = view.work.pair[k];
    parent[root(p.a)] = root(p.with_plane() || p.b >= n ? n : p.b);
  }
  std::vector<char> out(n);
  for (int i = 0; i < n; ++i) out[i] = root(i) == root(n);
  return out;
}

}  // namespace

std::vector<Quantity> pile_quantities(MeasureView const&) { return {{"angle", "deg"}, {"height", "m"}, {"rms", "m"}}; }

Values sample_pile(MeasureView const& view, Memory&) {
  MeasureRegion const region(view.measure);
  std::vector<char> const rests = resting(view);
  Vec3 const up = up_of(view.c);
  std::vector<int> heap;
  Vec3 moment;
  double mass = 0, base = std::numeric_limits<double>::infinity();
  for (int i = 0; i < view.scene.bodies(); ++i) {
    Vec3 const x = view.state.position[i];
    if (!view.state.is_active(i) || !rests[i] || !region.contains(x)) continue;
    heap.push_back(i);
    moment += x * view.scene.mass[i];
    mass += view.scene.mass[i];
    base = std::min(base, dot(x, up) - view.scene.diameter[i] / 2);
  }
  if (heap.empty()) return {nothing, nothing, nothing};
  Vec3 const axis = view.measure.through.value_or(moment / mass);
  bool const radial = !view.measure.direction;
  Vec3 sideways = radial ? (std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}) : *view.measure.direction;
  sideways = normalized(sideways - up * dot(sideways, up));
  Vec3 const other = cross(up, sideways);
  std::vector<SurfacePoint> points;
  for (int const i : heap) {
    Vec3 const r = view.state.position[i] - axis;
    double const x = dot(r, sideways), y = dot(r, other), top = dot(view.state.position[i], up);
    points.push_back(radial ? SurfacePoint{std::hypot(x, y), std::atan2(y, x), top} : SurfacePoint{x, y, top});
  }
  double const half = largest_diameter(view.scene) / 2;
  HeapFit const fit =
      fit_heap(points, radial, bin_of(view), base + half, view.measure.flank_low, view.measure.flank_high);
  return {-std::atan(fit.line.slope) * degrees, fit.top + half - base, fit.line.rms};
}

std::vector<Quantity> surface_quantities(MeasureView const&) {
  return {{"angle", "deg"}, {"offset", "m"}, {"rms", "m"}};
}

std::string check_surface(Case const& c, MeasureCase const& m) {
  if (std::string const wrong = check_one_scene(c, m); !wrong.empty()) return wrong;
  if (std::string const wrong = check_axis(c, m); !wrong.empty()) return wrong;
  if (norm(cross(normalized(axis_of(c, m)), up_of(c))) < 1e-6) return "the axis is vertical: such a drum has no slope";
  return "";
}

Values sample_surface(MeasureView const& view, Memory&) {
  MeasureCase const& m = view.measure;
  Vec3 const axis = normalized(axis_of(view.c, m)), through = through_of(view.c, m);
  Vec3 up = up_of(view.c);
  up = normalized(up - axis * dot(up, axis));
  Vec3 const sideways = cross(axis, up);
  WallCase const* const wall = wall_named(view.c, m.wall);
  double half = m.radius.value_or(wall && wall->kind == WallKind::cylinder ? wall->radius : 0) / 3;
  std::vector<SurfacePoint> points;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int i = 0; i < view.scene.bodies(); ++i) {
    if (!view.state.is_active(i)) continue;
    Vec3 const r = view.state.position[i] - through;
    points.push_back({dot(r, sideways), dot(r, axis), dot(r, up)});
    low = std::min(low, points.back().along), high = std::max(high, points.back().along);
  }
  double middle = 0;
  if (!(half > 0)) half = (high - low) / 6, middle = (high + low) / 2;
  std::erase_if(points, [&](SurfacePoint const& p) { return std::abs(p.along - middle) > half; });
  LineFit const fit = fit_surface(top_layer(points, bin_of(view)), flight * bin_of(view));
  // The bottom of a drum that turns by +rate moves towards -sideways and carries grains up there.
  double const rate = wall ? rate_of(view) : 0;
  return {std::atan(fit.slope) * degrees * (rate > 0 ? -1 : 1), fit.offset, fit.rms};
}

}  // namespace scree
