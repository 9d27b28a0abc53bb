// measure_motion.cpp: see measure_motion.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/measure_region.h"

namespace scree {
namespace {

double constexpr nothing = std::numeric_limits<double>::quiet_NaN();

// Bodies of the entry `grains` of the case; all without it.
std::vector<int> bodies_of(MeasureView const& view) {
  std::vector<int> out;
  for (int i = 0; i < view.scene.bodies(); ++i)
    if (view.measure.grains.empty() || view.c.grains[view.scene.group_of[i]].name == view.measure.grains)
      out.push_back(i);
  return out;
}

std::vector<int> followed(MeasureView const& view) {
  std::vector<int> const all = bodies_of(view);
  if (view.measure.index.empty()) return all;
  std::vector<int> out;
  for (double const i : view.measure.index) out.push_back(all[static_cast<std::size_t>(i)]);
  return out;
}

}  // namespace

std::vector<Quantity> trajectory_quantities(MeasureView const& view) {
  std::vector<Quantity> out;
  std::vector<double> index = view.measure.index;
  if (index.empty())
    for (std::size_t i = 0; i < bodies_of(view).size(); ++i) index.push_back(static_cast<double>(i));
  for (double const i : index)
    for (char const* what : {"x", "y", "z", "vx", "vy", "vz"})
      out.push_back({fmt::format("{}.{}", i, what), *what == 'v' ? "m/s" : "m"});
  return out;
}

Values sample_trajectory(MeasureView const& view, Memory&) {
  Values out;
  for (int const i : followed(view)) {
    Vec3 const x = view.state.position[i], v = view.state.velocity[i];
    bool const there = view.state.is_active(i);
    for (double const value : {x.x, x.y, x.z, v.x, v.y, v.z}) out.push_back(there ? value : nothing);
  }
  return out;
}

std::vector<Quantity> velocity_quantities(MeasureView const&) {
  return {{"mean", "m/s"}, {"largest", "m/s"}, {"x", "m/s"}, {"y", "m/s"}, {"z", "m/s"}, {"spin", "rad/s"}};
}

Values sample_velocity(MeasureView const& view, Memory&) {
  MeasureRegion const region(view.measure);
  Vec3 sum;
  double count = 0, speed = 0, largest = 0, spin = 0;
  for (int const i : bodies_of(view)) {
    if (!view.state.is_active(i) || !region.contains(view.state.position[i])) continue;
    Vec3 const v = view.state.velocity[i];
    ++count;
    sum += v;
    speed += norm(v);
    largest = std::max(largest, norm(v));
    spin += norm(spin_of(to_matrix(view.state.orientation[i]), view.scene.inertia[i], view.state.angular_momentum[i]));
  }
  if (count == 0) return Values(6, nothing);
  return {speed / count, largest, sum.x / count, sum.y / count, sum.z / count, spin / count};
}

std::vector<Quantity> run_out_quantities(MeasureView const&) {
  return {{"largest", "m"}, {"mean", "m"}, {"sideways", "m"}, {"sideways_spread", "m"}};
}

std::string check_run_out(Case const& c, MeasureCase const& m) {
  if (m.direction && is_finite(*m.direction) && norm(*m.direction) > 0 &&
      norm(cross(normalized(*m.direction), up_of(c))) < 1e-6)
    return "the direction is vertical: a run-out has a horizontal part";
  return "";
}

// memory: x, y, z of each body's release; NaN: not released yet.
void visit_run_out(MeasureView const& view, double, Memory& memory) {
  int const n = view.scene.bodies();
  if (memory.empty()) memory.assign(3 * static_cast<std::size_t>(n), nothing);
  for (int i = 0; i < n; ++i) {
    if (!std::isnan(memory[3 * i]) || !view.state.is_active(i)) continue;
    for (int k = 0; k < 3; ++k) memory[3 * i + k] = view.state.position[i][k];
  }
}

Values sample_run_out(MeasureView const& view, Memory& memory) {
  Vec3 const along = normalized(*view.measure.direction), across = normalized(cross(along, up_of(view.c)));
  double count = 0, largest = -std::numeric_limits<double>::infinity(), mean = 0, widest = 0, side = 0, square = 0;
  for (int const i : bodies_of(view)) {
    Vec3 const from{memory[3 * i], memory[3 * i + 1], memory[3 * i + 2]};
    if (!is_finite(from)) continue;
    Vec3 const way = view.state.position[i] - from;
    double const forth = dot(way, along), aside = dot(way, across);
    ++count;
    largest = std::max(largest, forth);
    mean += forth;
    widest = std::max(widest, std::abs(aside));
    side += aside;
    square += aside * aside;
  }
  if (count == 0) return Values(4, nothing);
  double const variance = count > 1 ? (square - side * side / count) / (count - 1) : 0;
  return {largest, mean / count, widest, std::sqrt(std::max(0.0, variance))};
}

}  // namespace scree
