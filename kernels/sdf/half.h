// half.h: half precision (IEEE 754 binary16) in pairs, as tensor cores take it: two halves in a 32-bit register.
// On the host by bits, so that the same registers exist there.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__CUDACC__)
#include <cuda_fp16.h>
#endif

#include <cstdint>
#include <cstring>

#include "kernels/base/config.h"

namespace scree::sdf_fused {

using Half2 = std::uint32_t;  // the first of two neighbouring columns is in the lower 16 bits

double constexpr largest_half = 65504;  // what rounds to 65520 or more is infinite
// Below 2^-14 a half has no hidden bit: it is a multiple of 2^-24, and its relative error grows.

// To the nearest, ties to even.
inline std::uint16_t half_bits(float x) {
  std::uint32_t f;
  std::memcpy(&f, &x, 4);
  std::uint32_t const sign = f >> 16 & 0x8000u;
  f &= 0x7fffffffu;
  if (f > 0x7f800000u) return static_cast<std::uint16_t>(sign | 0x7e00u);   // NaN
  if (f >= 0x477ff000u) return static_cast<std::uint16_t>(sign | 0x7c00u);  // 65520 and more
  if (f < 0x38800000u) {  // a multiple of 2^-24, the last place of a float in [0.5, 1): the sum rounds there
    float magnitude;
    std::memcpy(&magnitude, &f, 4);
    magnitude += 0.5f;
    std::memcpy(&f, &magnitude, 4);
    return static_cast<std::uint16_t>(sign | (f - 0x3f000000u));
  }
  f += 0xfffu + (f >> 13 & 1u);
  return static_cast<std::uint16_t>(sign | (f - 0x38000000u) >> 13);
}

inline float half_value(std::uint32_t h) {
  // A half's exponent counts from 15, a float's from 127; the product is exact, also of what has no hidden bit.
  std::uint32_t const shifted = (h & 0x7fffu) << 13;
  float magnitude;
  std::memcpy(&magnitude, &shifted, 4);
  magnitude *= 0x1p112f;
  if ((h & 0x7c00u) == 0x7c00u) {  // infinite, or no number
    std::uint32_t const special = 0x7f800000u | shifted;
    std::memcpy(&magnitude, &special, 4);
  }
  return h & 0x8000u ? -magnitude : magnitude;
}

SCREE_HD inline Half2 pack_halves(float first, float second) {
#if defined(__CUDA_ARCH__)
  __half2 const h = __floats2half2_rn(first, second);
  Half2 bits;
  memcpy(&bits, &h, 4);
  return bits;
#else
  return half_bits(first) | static_cast<std::uint32_t>(half_bits(second)) << 16;
#endif
}

SCREE_HD inline void unpack_halves(Half2 pair, float& first, float& second) {
#if defined(__CUDA_ARCH__)
  __half2 h;
  memcpy(&h, &pair, 4);
  float2 const both = __half22float2(h);
  first = both.x, second = both.y;
#else
  first = half_value(pair & 0xffffu), second = half_value(pair >> 16);
#endif
}

// x = high + low to 2^-22 of x, as long as the low part is a normal half: |x| >= 2^-3 (below, to 2^-25 absolute), and
// |x| < 65504. Values are therefore scaled by powers of two until the largest are near the upper end.
SCREE_HD inline void split_halves(float first, float second, Half2& high, Half2& low) {
  high = pack_halves(first, second);
  float a, b;
  unpack_halves(high, a, b);
  low = pack_halves(first - a, second - b);  // the differences are exact
}

}  // namespace scree::sdf_fused
