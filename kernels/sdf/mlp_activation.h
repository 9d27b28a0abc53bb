// mlp_activation.h: hidden activations and their slopes, as templates over a vector (or scalar) of floats V.
// Every evaluator uses these, so a point has the same bits on any of them that rounds a b + c once.
// V: constant (a literal), broadcast (from memory), fma(a, b, c) = a b + c, operators + - *, divide(a, b),
//   maximum(a, b) (b when one is NaN), positive(s, a, b) = s > 0 ? a : b, flip_odd(v, t) = v with its sign flipped
//   where the lowest bit of t is set, exponent_shift(v, t) = v * 2^(low bits of t).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__CUDACC__)
#define SCREE_INLINE __host__ __device__ __forceinline__
#else
#define SCREE_INLINE inline __attribute__((always_inline))
#endif

namespace scree::sdf_activation {
namespace {  // one private copy for each file that includes this: flags of the ISA files must not leak

// t = v + magic leaves round(v) in the low mantissa bits, for |v| < 2^22.
constexpr float magic = 12582912.0f;  // 1.5 * 2^23

// h = max(z, slope z). The sign of h says which branch was taken, so the backward pass remembers h itself.
template <class V>
struct LeakyRelu {
  static constexpr bool remembers_value = true;
  V slope;
  template <class Net>
  explicit SCREE_INLINE LeakyRelu(Net const& net) : slope(V::broadcast(net.slope)) {}
  SCREE_INLINE V value(V z) const { return V::maximum(slope * z, z); }
  SCREE_INLINE V value_and_record(V z, V& record) const { return record = value(z); }
  SCREE_INLINE V backward(V g, V record) const { return V::positive(record, g, slope * g); }
};

// h = sin(pi z); omega / pi is folded into the weights, which makes the range reduction z - round(z) exact.
// Polynomials: least-maximum fits on |f| <= 1/2, absolute errors 3e-9 (sine) and 5e-8 (cosine); with float rounding
// 1.8e-7. The record is cos(pi z); the backward weights carry omega.
template <class V>
struct Sine {
  static constexpr bool remembers_value = false;
  template <class Net>
  explicit SCREE_INLINE Sine(Net const&) {}
  static SCREE_INLINE V sine_of(V f, V f2, V t) {
    V p = V::constant(0.0772201281f);
    p = V::fma(p, f2, V::constant(-0.598045174f));
    p = V::fma(p, f2, V::constant(2.55003138f));
    p = V::fma(p, f2, V::constant(-5.16770688f));
    p = V::fma(p, f2, V::constant(3.14159258f));
    return V::flip_odd(p * f, t);
  }
  SCREE_INLINE V value(V z) const {
    V const t = z + V::constant(magic);
    V const f = z - (t - V::constant(magic));
    return sine_of(f, f * f, t);
  }
  SCREE_INLINE V value_and_record(V z, V& record) const {
    V const t = z + V::constant(magic);
    V const f = z - (t - V::constant(magic));
    V const f2 = f * f;
    V p = V::constant(0.220080616f);
    p = V::fma(p, f2, V::constant(-1.33209385f));
    p = V::fma(p, f2, V::constant(4.05845134f));
    p = V::fma(p, f2, V::constant(-4.93479552f));
    p = V::fma(p, f2, V::constant(1.0f));
    record = V::flip_odd(p, t);
    return sine_of(f, f2, t);
  }
  SCREE_INLINE V backward(V g, V record) const { return g * record; }
};

// h = log(1 + exp(z)) = max(z, 0) + log1p(u), u = exp(-|z|); beta is folded into first and last weights.
// exp: Cody-Waite reduction and the polynomial of Cephes (Moshier 1992, expf). log1p(u) = 2 atanh(u / (2 + u)), fit in
// the square, error 8e-9. The record is the logistic function.
template <class V>
struct Softplus {
  static constexpr bool remembers_value = false;
  template <class Net>
  explicit SCREE_INLINE Softplus(Net const&) {}
  static SCREE_INLINE V exp_negative(V x) {  // x <= 0
    x = V::maximum(V::constant(-87.0f), x);
    V const t = V::fma(x, V::constant(1.44269504f), V::constant(magic));
    V const n = t - V::constant(magic);
    V r = V::fma(n, V::constant(-0.693359375f), x);
    r = V::fma(n, V::constant(2.12194440e-4f), r);
    V p = V::constant(1.9875691500e-4f);
    p = V::fma(p, r, V::constant(1.3981999507e-3f));
    p = V::fma(p, r, V::constant(8.3334519073e-3f));
    p = V::fma(p, r, V::constant(4.1665795894e-2f));
    p = V::fma(p, r, V::constant(1.6666665459e-1f));
    p = V::fma(p, r, V::constant(5.0000001201e-1f));
    return V::exponent_shift(V::fma(p, r * r, r + V::constant(1.0f)), t);
  }
  SCREE_INLINE V value_and_record(V z, V& record) const {
    V const one = V::constant(1.0f);
    V const u = exp_negative(V::positive(z, V::constant(0.0f) - z, z));
    V const s = V::divide(u, u + V::constant(2.0f));
    V const s2 = s * s;
    V p = V::constant(0.244249007f);
    p = V::fma(p, s2, V::constant(0.213899628f));
    p = V::fma(p, s2, V::constant(0.286210419f));
    p = V::fma(p, s2, V::constant(0.399986782f));
    p = V::fma(p, s2, V::constant(0.666666795f));
    p = V::fma(p, s2, V::constant(2.0f));
    record = V::divide(V::positive(z, one, u), one + u);
    return V::fma(p, s, V::maximum(V::constant(0.0f), z));
  }
  SCREE_INLINE V value(V z) const {
    V unused;
    return value_and_record(z, unused);
  }
  SCREE_INLINE V backward(V g, V record) const { return g * record; }
};

}  // namespace
}  // namespace scree::sdf_activation
