// device_meters.h: what bench_device compares the network kernel with, on the same GPU: its peak and a level-set grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sdf/grid.h"

namespace scree::bench {

// fp32 multiply-adds of all multiprocessors, measured now with independent chains [FLOP/s]; median of five launches.
double measure_device_peak();

// Kernel time [s] of one trilinear lookup a point, median of `rounds`: phi[i] of grid `which[i]`. All grids have the
// frame `frame`; `value` holds them one after the other. Points, indices and results are already on the device.
double time_grid_lookups(GridFrame const& frame, Span<const float> value, Span<const Vec3> point, Span<const int> which,
                         int rounds, Span<double> phi);

}  // namespace scree::bench
