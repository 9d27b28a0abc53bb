// time_table.h: a piecewise-linear function of time, constant before its first and after its last point.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace scree {

struct TimeTable {
  std::vector<double> time;   // [s], ascending; two equal times make a jump
  std::vector<double> value;  // as many

  bool empty() const { return time.empty(); }
  friend bool operator==(TimeTable const&, TimeTable const&) = default;
};

// Mean of the table over [from, to], exact; at a jump the later value counts when from == to. The table is not empty.
double mean_over(TimeTable const& table, double from, double to);

// Share of [from, to] that lies in [start, stop).
double share_inside(double start, double stop, double from, double to);

}  // namespace scree
