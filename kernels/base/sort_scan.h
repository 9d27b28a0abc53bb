// sort_scan.h: stable sort of keyed indices and exclusive scan, behind spans (Thrust inside).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernels/base/queue.h"
#include "kernels/base/span.h"

namespace scree {

// Stable ascending sort of `key` carrying `value`, in place (n each). Deterministic for any thread count.
void sort_by_key(Queue const& queue, Span<std::uint64_t> key, Span<int> value);

// sum[i] = value[0] + ... + value[i-1]; sum has n + 1 entries, the last one is the total. In place is not allowed.
void exclusive_scan(Queue const& queue, Span<const int> value, Span<int> sum);

}  // namespace scree
