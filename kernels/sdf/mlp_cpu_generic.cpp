// mlp_cpu_generic.cpp: the batch evaluator for any CPU, through the compiler's portable 16-byte vectors.
// Multiply and add round separately here: a software fma would cost a hundred times more.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/mlp_cpu_block.h"

namespace scree::sdf_cpu {
namespace {

struct Generic {
  static constexpr int size = 4;
  static constexpr int vectors = 2;  // with a panel of 4: 8 accumulators, room for products in 16 registers
  static constexpr int panel = 4;
  using Floats = float __attribute__((vector_size(16), may_alias));
  using Ints = int __attribute__((vector_size(16)));
  Floats v;

  static SCREE_INLINE Generic load(float const* p) { return {*reinterpret_cast<Floats const*>(p)}; }
  static SCREE_INLINE void store(float* p, Generic a) { *reinterpret_cast<Floats*>(p) = a.v; }
  static SCREE_INLINE Generic broadcast(float const& x) { return {Floats{x, x, x, x}}; }
  static SCREE_INLINE Generic constant(float x) { return {Floats{x, x, x, x}}; }
  static SCREE_INLINE Generic fma(Generic a, Generic b, Generic c) { return {a.v * b.v + c.v}; }
  static SCREE_INLINE Generic maximum(Generic a, Generic b) { return {a.v > b.v ? a.v : b.v}; }
  static SCREE_INLINE Generic divide(Generic a, Generic b) { return {a.v / b.v}; }
  static SCREE_INLINE Generic positive(Generic s, Generic a, Generic b) { return {s.v > 0.0f ? a.v : b.v}; }
  static SCREE_INLINE Generic flip_odd(Generic a, Generic t) {
    return {reinterpret_cast<Floats>(reinterpret_cast<Ints>(a.v) ^ (reinterpret_cast<Ints>(t.v) << 31))};
  }
  static SCREE_INLINE Generic exponent_shift(Generic a, Generic t) {
    return {reinterpret_cast<Floats>(reinterpret_cast<Ints>(a.v) + (reinterpret_cast<Ints>(t.v) << 23))};
  }
  friend SCREE_INLINE Generic operator+(Generic a, Generic b) { return {a.v + b.v}; }
  friend SCREE_INLINE Generic operator-(Generic a, Generic b) { return {a.v - b.v}; }
  friend SCREE_INLINE Generic operator*(Generic a, Generic b) { return {a.v * b.v}; }
};

}  // namespace

extern constexpr Isa generic_isa = make_isa<Generic>("generic");

}  // namespace scree::sdf_cpu
