// mlp_cpu_avx2.cpp: the batch evaluator for AVX2 + FMA: blocks of 24 points, 12 accumulators.
// SPDX-License-Identifier: Apache-2.0
#include <immintrin.h>

#include "kernels/sdf/mlp_cpu_block.h"

namespace scree::sdf_cpu {
namespace {

struct Avx2 {
  static constexpr int size = 8;
  static constexpr int vectors = 3;  // with a panel of 4: 12 accumulators + 3 activations + 1 weight = 16 registers
  static constexpr int panel = 4;
  __m256 v;

  static SCREE_INLINE Avx2 load(float const* p) { return {_mm256_load_ps(p)}; }
  static SCREE_INLINE void store(float* p, Avx2 a) { _mm256_store_ps(p, a.v); }
  static SCREE_INLINE Avx2 broadcast(float const& x) { return {_mm256_broadcast_ss(&x)}; }
  static SCREE_INLINE Avx2 constant(float x) { return {_mm256_set1_ps(x)}; }
  static SCREE_INLINE Avx2 fma(Avx2 a, Avx2 b, Avx2 c) { return {_mm256_fmadd_ps(a.v, b.v, c.v)}; }
  static SCREE_INLINE Avx2 maximum(Avx2 a, Avx2 b) { return {_mm256_max_ps(a.v, b.v)}; }
  static SCREE_INLINE Avx2 divide(Avx2 a, Avx2 b) { return {_mm256_div_ps(a.v, b.v)}; }
  static SCREE_INLINE Avx2 positive(Avx2 s, Avx2 a, Avx2 b) {
    return {_mm256_blendv_ps(b.v, a.v, _mm256_cmp_ps(s.v, _mm256_setzero_ps(), _CMP_GT_OQ))};
  }
  static SCREE_INLINE Avx2 flip_odd(Avx2 a, Avx2 t) {
    return {_mm256_xor_ps(a.v, _mm256_castsi256_ps(_mm256_slli_epi32(_mm256_castps_si256(t.v), 31)))};
  }
  static SCREE_INLINE Avx2 exponent_shift(Avx2 a, Avx2 t) {
    return {_mm256_castsi256_ps(
        _mm256_add_epi32(_mm256_castps_si256(a.v), _mm256_slli_epi32(_mm256_castps_si256(t.v), 23)))};
  }
  friend SCREE_INLINE Avx2 operator+(Avx2 a, Avx2 b) { return {_mm256_add_ps(a.v, b.v)}; }
  friend SCREE_INLINE Avx2 operator-(Avx2 a, Avx2 b) { return {_mm256_sub_ps(a.v, b.v)}; }
  friend SCREE_INLINE Avx2 operator*(Avx2 a, Avx2 b) { return {_mm256_mul_ps(a.v, b.v)}; }
};

}  // namespace

extern constexpr Isa avx2_isa = make_isa<Avx2>("avx2");

}  // namespace scree::sdf_cpu
