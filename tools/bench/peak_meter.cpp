// peak_meter.cpp: the FMA throughput and the clock of the core the program runs on.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>

#include "tools/bench/peak_meter.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace scree::bench {

namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

int constexpr chains = 12;      // 4 cycles of latency x 2 units = 8 at least
int constexpr trips = 1 << 16;  // x 12 FMA / 2 a cycle: 0.4 M cycles, 0.1 ms

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) void fma_trips_avx2() {
  __m256 a[chains];
  for (auto& x : a) x = _mm256_set1_ps(1.0f);
  __m256 const b = _mm256_set1_ps(0.999f), c = _mm256_set1_ps(0.001f);
  for (int i = 0; i < trips; ++i)
#pragma GCC unroll 12
    for (int k = 0; k < chains; ++k) a[k] = _mm256_fmadd_ps(a[k], b, c);
#pragma GCC unroll 12
  for (int k = 0; k < chains; ++k) asm volatile("" : : "x"(a[k]));  // the results count as used
}

__attribute__((target("avx512f"))) void fma_trips_avx512() {
  __m512 a[chains];
  for (auto& x : a) x = _mm512_set1_ps(1.0f);
  __m512 const b = _mm512_set1_ps(0.999f), c = _mm512_set1_ps(0.001f);
  for (int i = 0; i < trips; ++i)
#pragma GCC unroll 12
    for (int k = 0; k < chains; ++k) a[k] = _mm512_fmadd_ps(a[k], b, c);
#pragma GCC unroll 12
  for (int k = 0; k < chains; ++k) asm volatile("" : : "v"(a[k]));
}

int lanes() { return __builtin_cpu_supports("avx512f") ? 16 : __builtin_cpu_supports("avx2") ? 8 : 0; }
#else
int lanes() { return 0; }
#endif

}  // namespace

double flop_per_cycle() { return 2.0 * lanes() * 2.0; }

// The fastest of many short trips: a preempted one says nothing of the core.
double measure_peak(int threads) {
#if defined(__x86_64__)
  if (lanes() == 0) return 0;
  double shortest = 1e9;
  // Barriers round every trip: what counts is when the last of the threads is through.
#pragma omp parallel num_threads(threads)
  for (int repeat = 0; repeat < 30; ++repeat) {
#pragma omp barrier
    double const start = now();
    lanes() == 16 ? fma_trips_avx512() : fma_trips_avx2();
#pragma omp barrier
#pragma omp master
    shortest = std::min(shortest, now() - start);
  }
  return 2.0 * threads * chains * lanes() * trips / shortest;
#else
  return 0 * threads;
#endif
}

double measure_clock() {
#if defined(__x86_64__)
  double shortest = 1e9;
  int constexpr additions = 32, loops = 1 << 13;
  for (int repeat = 0; repeat < 20; ++repeat) {
    unsigned long x = 0, step = 1;  // a register: some cores add small constants for nothing while renaming
    double const start = now();
    for (int i = 0; i < loops; ++i)
      asm volatile(
          ".rept 32\n\t"
          "add %1, %0\n\t"
          ".endr"
          : "+r"(x)
          : "r"(step));
    double const seconds = now() - start;
    if (seconds < shortest) shortest = seconds;
  }
  return double(additions) * loops / shortest;
#else
  return 0;
#endif
}

}  // namespace scree::bench
