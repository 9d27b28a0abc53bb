// wall_motion.cpp: see wall_motion.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/wall_motion.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

// Integral up to t of a table that is linear between its times and constant beyond them; from time 0.
template <class T>
T integral_of_table(std::vector<double> const& time, std::vector<T> const& value, double t) {
  auto const up_to = [&](double end) {  // from time.front(), which may be negative
    T sum = value.front() * std::min(0.0, end - time.front());
    for (std::size_t i = 0; i + 1 < time.size() && end > time[i]; ++i) {
      double const step = std::min(end, time[i + 1]) - time[i];
      T const slope = (value[i + 1] - value[i]) * (1 / (time[i + 1] - time[i]));
      sum = sum + value[i] * step + slope * (0.5 * step * step);
    }
    return sum + value.back() * std::max(0.0, end - time.back());
  };
  return up_to(t) - up_to(0);
}

template <class T>
T value_of_table(std::vector<double> const& time, std::vector<T> const& value, double t) {
  if (t <= time.front()) return value.front();
  for (std::size_t i = 0; i + 1 < time.size(); ++i)
    if (t < time[i + 1]) return value[i] + (value[i + 1] - value[i]) * ((t - time[i]) / (time[i + 1] - time[i]));
  return value.back();
}

}  // namespace

WallShift shift_at(MotionCase const& m, double time) {
  WallShift out;
  double const moving = std::clamp(time, m.start, m.end) - m.start;
  if (m.kind == MotionKind::rotation)
    out.angle = m.time.empty() ? m.rate * moving : integral_of_table(m.time, m.rates, time);
  else
    out.translation = m.time.empty() ? m.velocity * moving : integral_of_table(m.time, m.velocities, time);
  return out;
}

WallPose pose_at(MotionCase const& m, Vec3 position, Quat orientation, double time) {
  WallShift const s = shift_at(m, time);
  if (m.kind == MotionKind::translation) return {position + s.translation, orientation};
  Quat const turn = quat_from_rotation_vector(normalized(m.axis) * s.angle);
  return {m.through + to_matrix(turn) * (position - m.through), normalized(turn * orientation)};
}

double rate_at(MotionCase const& m, double time) {
  if (m.kind == MotionKind::translation) return 0;
  if (!m.time.empty()) return value_of_table(m.time, m.rates, time);
  return time >= m.start && time < m.end ? m.rate : 0;
}

double fastest(MotionCase const& m, Vec3 centre, double radius) {
  double largest = 0;
  if (m.kind == MotionKind::translation) {
    for (Vec3 const& v : m.velocities) largest = std::max(largest, norm(v));
    return m.time.empty() ? norm(m.velocity) : largest;
  }
  for (double const rate : m.rates) largest = std::max(largest, std::fabs(rate));
  double const rate = m.time.empty() ? std::fabs(m.rate) : largest;
  Vec3 const arm = cross(normalized(m.axis), centre - m.through);
  return rate * (norm(arm) + radius);
}

}  // namespace scree
