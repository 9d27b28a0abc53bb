// prefetch.h: asks for memory that a loop will need some items later.
// Nothing but time depends on it. Neighbours in a list of pairs need not be neighbours in memory: of 100,000 grains in
// random order each pair waits for main memory otherwise.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/span.h"

namespace scree {

// Items ahead, enough to cover the way to main memory by the work on those in between.
int constexpr prefetch_ahead = 8;

// The cache lines of values[i]; i must be valid. On a GPU the other warps cover the wait.
template <class T>
SCREE_HD inline void prefetch(Span<T> const& values, int i) {
#if !defined(__CUDA_ARCH__)
  int constexpr line = 64;  // [bytes]
  auto const* const begin = reinterpret_cast<char const*>(values.data + i);
  for (int at = 0; at < static_cast<int>(sizeof(T)); at += line) __builtin_prefetch(begin + at);
  __builtin_prefetch(begin + sizeof(T) - 1);
#endif
}

}  // namespace scree
