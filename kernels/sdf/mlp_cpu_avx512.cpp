// mlp_cpu_avx512.cpp: the batch evaluator for AVX-512F: blocks of 48 points, 24 accumulators.
// SPDX-License-Identifier: Apache-2.0
#include <immintrin.h>

#include "kernels/sdf/mlp_cpu_block.h"

namespace scree::sdf_cpu {
namespace {

struct Avx512 {
  static constexpr int size = 16;
  static constexpr int vectors = 3;  // with a panel of 8: 24 accumulators + 3 activations, 5 of 32 registers to spare
  static constexpr int panel = 8;
  __m512 v;

  static SCREE_INLINE Avx512 load(float const* p) { return {_mm512_load_ps(p)}; }
  static SCREE_INLINE void store(float* p, Avx512 a) { _mm512_store_ps(p, a.v); }
  static SCREE_INLINE Avx512 broadcast(float const& x) { return {_mm512_set1_ps(x)}; }
  static SCREE_INLINE Avx512 constant(float x) { return {_mm512_set1_ps(x)}; }
  static SCREE_INLINE Avx512 fma(Avx512 a, Avx512 b, Avx512 c) { return {_mm512_fmadd_ps(a.v, b.v, c.v)}; }
  static SCREE_INLINE Avx512 maximum(Avx512 a, Avx512 b) { return {_mm512_max_ps(a.v, b.v)}; }
  static SCREE_INLINE Avx512 divide(Avx512 a, Avx512 b) { return {_mm512_div_ps(a.v, b.v)}; }
  static SCREE_INLINE Avx512 positive(Avx512 s, Avx512 a, Avx512 b) {
    return {_mm512_mask_blend_ps(_mm512_cmp_ps_mask(s.v, _mm512_setzero_ps(), _CMP_GT_OQ), b.v, a.v)};
  }
  static SCREE_INLINE Avx512 flip_odd(Avx512 a, Avx512 t) {  // the float xor would need AVX-512DQ
    return {_mm512_castsi512_ps(
        _mm512_xor_si512(_mm512_castps_si512(a.v), _mm512_slli_epi32(_mm512_castps_si512(t.v), 31)))};
  }
  static SCREE_INLINE Avx512 exponent_shift(Avx512 a, Avx512 t) {
    return {_mm512_castsi512_ps(
        _mm512_add_epi32(_mm512_castps_si512(a.v), _mm512_slli_epi32(_mm512_castps_si512(t.v), 23)))};
  }
  friend SCREE_INLINE Avx512 operator+(Avx512 a, Avx512 b) { return {_mm512_add_ps(a.v, b.v)}; }
  friend SCREE_INLINE Avx512 operator-(Avx512 a, Avx512 b) { return {_mm512_sub_ps(a.v, b.v)}; }
  friend SCREE_INLINE Avx512 operator*(Avx512 a, Avx512 b) { return {_mm512_mul_ps(a.v, b.v)}; }
};

}  // namespace

extern constexpr Isa avx512_isa = make_isa<Avx512>("avx512");

}  // namespace scree::sdf_cpu
