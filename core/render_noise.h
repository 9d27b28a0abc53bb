// render_noise.h: repeatable noise for pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace scree {

inline double unit_noise(std::uint32_t x) {  // 0..1 by Wang's integer hash
  x = (x ^ 61u) ^ (x >> 16);
  x *= 9u;
  x ^= x >> 4;
  x *= 0x27d4eb2du;
  return (x ^ (x >> 15)) / 4294967296.0;
}

}  // namespace scree
