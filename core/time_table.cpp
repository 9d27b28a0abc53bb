// time_table.cpp: see time_table.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/time_table.h"

#include <algorithm>

namespace scree {
namespace {

// Value at t inside segment k, which has a length.
double on_segment(TimeTable const& table, std::size_t k, double t) {
  double const share = (t - table.time[k]) / (table.time[k + 1] - table.time[k]);
  return table.value[k] + share * (table.value[k + 1] - table.value[k]);
}

}  // namespace

double mean_over(TimeTable const& table, double from, double to) {
  std::vector<double> const& time = table.time;
  if (to <= time.front() && from < time.front()) return table.value.front();
  if (from >= time.back()) return table.value.back();
  // A linear piece has its mean in its middle.
  if (from == to) {
    std::size_t const k = std::upper_bound(time.begin(), time.end(), from) - time.begin();
    return k == 0 ? table.value.front() : on_segment(table, k - 1, from);
  }
  double sum = 0;
  if (from < time.front()) sum += (std::min(to, time.front()) - from) * table.value.front();
  for (std::size_t k = 0; k + 1 < time.size(); ++k) {
    double const low = std::max(from, time[k]), high = std::min(to, time[k + 1]);
    if (low < high) sum += (high - low) * on_segment(table, k, 0.5 * (low + high));
  }
  if (to > time.back()) sum += (to - std::max(from, time.back())) * table.value.back();
  return sum / (to - from);
}

double share_inside(double start, double stop, double from, double to) {
  if (start <= from && to <= stop) return 1;  // exactly, so that a constant force is constant
  double const inside = std::min(to, stop) - std::max(from, start);
  return inside > 0 && to > from ? inside / (to - from) : 0;
}

}  // namespace scree
