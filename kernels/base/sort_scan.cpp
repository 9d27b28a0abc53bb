// sort_scan.cpp: the one file that sees Thrust.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/sort_scan.h"

#include <thrust/execution_policy.h>
#include <thrust/scan.h>
#include <thrust/sort.h>
#include <thrust/system/cpp/execution_policy.h>
#include <thrust/system/omp/execution_policy.h>

#include <stdexcept>

namespace scree {

namespace {
// Below this many items Thrust's OpenMP merge sort loses to one thread.
int constexpr parallel_from = 1 << 14;
}  // namespace

void sort_by_key(Queue const& queue, Span<std::uint64_t> key, Span<int> value) {
  if (key.size() != value.size()) throw std::invalid_argument("sort_by_key: key and value differ in size");
  if (queue.threads > 1 && key.size() >= parallel_from)
    thrust::stable_sort_by_key(thrust::omp::par, key.begin(), key.end(), value.begin());
  else
    thrust::stable_sort_by_key(thrust::cpp::par, key.begin(), key.end(), value.begin());
}

void exclusive_scan(Queue const&, Span<const int> value, Span<int> sum) {
  if (sum.size() != value.size() + 1) throw std::invalid_argument("exclusive_scan: sum must hold one more than value");
  // Memory-bound and short next to every other stage: one thread.
  thrust::exclusive_scan(thrust::cpp::par, value.begin(), value.end(), sum.begin(), 0);
  sum[value.size()] = value.empty() ? 0 : sum[value.size() - 1] + value[value.size() - 1];
}

}  // namespace scree
