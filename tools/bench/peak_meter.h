// peak_meter.h: what the arithmetic units of this machine can do, measured now.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace scree::bench {

// FMA throughput in float of one core with the widest vectors, measured for some 4 ms with independent chains [FLOP/s];
// with `threads`, of that many at once. 0: not known for this kind of processor.
double measure_peak(int threads = 1);

// Core clock from the latency of dependent integer additions, one cycle each on every x86-64 core [Hz]. Some 2 ms.
double measure_clock();

// What clock and FMA units allow: FLOP a cycle = 2 units x lanes x 2. (Some AVX-512 parts have one unit only.)
double flop_per_cycle();

}  // namespace scree::bench
