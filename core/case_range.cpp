// case_range.cpp: see case_range.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_range.h"

#include <fmt/format.h>

#include <cmath>

namespace scree {

std::string out_of_range(double value, double low, bool low_allowed, double high, char const* reason) {
  if (std::isfinite(value) && (low_allowed ? value >= low : value > low) && value <= high) return "";
  std::string const upper = std::isfinite(high)    ? fmt::format(" and <= {}", high)
                            : std::isfinite(value) ? ""
                                                   : " and finite";
  return fmt::format("{} is out of range: must be {} {}{} ({})", value, low_allowed ? ">=" : ">", low, upper, reason);
}

}  // namespace scree
