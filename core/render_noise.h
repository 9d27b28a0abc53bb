// render_noise.h: repeatable noise for pictures.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "kernels/base/vec.h"

namespace scree {

inline double unit_noise(std::uint32_t x) {  // 0..1 by Wang's integer hash
  x = (x ^ 61u) ^ (x >> 16);
  x *= 9u;
  x ^= x >> 4;
  x *= 0x27d4eb2du;
  return (x ^ (x >> 15)) / 4294967296.0;
}

// Value noise, smooth between the corners of a unit lattice, 0..1. In a body's own frame it is speckle that turns with
// the grain, so that rotation shows.
inline double speckle(Vec3 p, std::uint32_t seed) {
  int const x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y)),
            z = static_cast<int>(std::floor(p.z));
  double const f[3] = {p.x - x, p.y - y, p.z - z};
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    int const dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
    double weight = 1;
    int const bit[3] = {dx, dy, dz};
    for (int i = 0; i < 3; ++i) {
      double const s = f[i] * f[i] * (3 - 2 * f[i]);
      weight *= bit[i] ? s : 1 - s;
    }
    sum += weight *
           unit_noise(seed + 73856093u * static_cast<std::uint32_t>(x + dx) +
                      19349663u * static_cast<std::uint32_t>(y + dy) + 83492791u * static_cast<std::uint32_t>(z + dz));
  }
  return sum;
}

}  // namespace scree
