// device_meters_absent.cpp: device_meters.h in a build without CUDA: the emulated kernel is compared with nothing.
// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "tools/bench/device_meters.h"

namespace scree::bench {

double measure_device_peak() { return std::numeric_limits<double>::quiet_NaN(); }

double time_grid_lookups(GridFrame const&, Span<const float>, Span<const Vec3>, Span<const int>, int, Span<double>) {
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace scree::bench
