// tensor_warp.h: a warp with tensor cores, and its stand-in under g++: 32 lanes that hold the very registers PTX names.
//
// A warp holds matrices in pieces ("fragments"), a few elements a lane. All shapes used here are made of blocks of 8
// columns of A (rows of B), so that one map serves mma.m16n8k16 and mma.m16n8k8 (PTX ISA, "Matrix fragments for
// mma.m16n8k16 with floating point type" and "... mma.m16n8k8"). With g = lane / 4 and t = lane % 4:
//   A (16 x 8): register r = 0, 1: row g + 8 r, columns 2 t and 2 t + 1
//   B (8 x 8):  one register: rows 2 t and 2 t + 1, column g
//   C (16 x 8): element i = 0 ... 3: row g + 8 (i / 2), column 2 t + i % 2
// m16n8k16 takes the registers of one block, then those of the next.
// C has A's map: what comes out of a layer, rounded in place, is the next layer's A. No lane hands anything on.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/sdf/half.h"
#include "kernels/sdf/mlp_fused.h"

namespace scree::sdf_fused {

int constexpr warp_lanes = 32;
SCREE_HD constexpr int fragment_row(int lane) { return lane / 4; }         // g
SCREE_HD constexpr int fragment_column(int lane) { return lane % 4 * 2; }  // 2 t

struct Accumulator {
  float v[4];
};

// What the text of tensor_tile.h asks of a warp W:
//   W::Own<T>: a T in every lane's registers, own[lane]
//   each(step): step(lane) for all lanes
//   multiply_16(c, a, a_next, b, b_next), multiply_8(c, a, b): c += A B over 16 or 8 columns of A
//   from_row(x, first, out): out = x of lane first + g
//   quad_sum(x): the sum over the four lanes of a row, in all of them
//   to_owner(x, out): out = x of the four lanes that hold row lane % 8
//   floats_2(p), words_2(p, ...), word(p): neighbours that no kernel writes, aligned to what is read
// LoopWarp runs on the host. Its tensor core multiplies exactly and rounds what it adds to the accumulator toward zero,
// the worst that was found of the real ones (Fasi, Higham, Mikaitis, Pranesh 2021, PeerJ Comput. Sci. 7:e330).
struct LoopWarp {
  template <class T>
  struct Own {
    T v[warp_lanes];
    T& operator[](int lane) { return v[lane]; }
    T const& operator[](int lane) const { return v[lane]; }
  };

  template <class Step>
  void each(Step const& step) const {
    for (int lane = 0; lane < warp_lanes; ++lane) step(lane);
  }

  void multiply_16(Own<Accumulator>& c, Own<Half2> const (&a)[2], Own<Half2> const (&a_next)[2], Own<Half2> const& b,
                   Own<Half2> const& b_next) const {
    double left[16][16], right[16][8];
    place_a(a, left, 0), place_a(a_next, left, 8);
    place_b(b, right, 0), place_b(b_next, right, 8);
    add_product<16>(left, right, c);
  }
  void multiply_8(Own<Accumulator>& c, Own<Half2> const (&a)[2], Own<Half2> const& b) const {
    double left[16][16], right[16][8];
    place_a(a, left, 0), place_b(b, right, 0);
    add_product<8>(left, right, c);
  }

  template <class T>
  void from_row(Own<T> const& x, int first, Own<T>& out) const {
    for (int lane = 0; lane < warp_lanes; ++lane) out[lane] = x[first + fragment_row(lane)];
  }
  void quad_sum(Own<float>& x) const {
    for (int quad = 0; quad < warp_lanes; quad += 4) {
      float const sum = (x[quad] + x[quad + 1]) + (x[quad + 2] + x[quad + 3]);
      for (int t = 0; t < 4; ++t) x[quad + t] = sum;
    }
  }
  void to_owner(Own<float> const& x, Own<float>& out) const {
    for (int lane = 0; lane < warp_lanes; ++lane) out[lane] = x[lane % 8 * 4];
  }
  static Pack<2> floats_2(float const* p) { return load<2>(p); }
  static Half2 word(Half2 const* p) { return *p; }
  static void words_2(Half2 const* p, Half2& first, Half2& second) { first = p[0], second = p[1]; }

 private:
  static void place_a(Own<Half2> const (&a)[2], double (&left)[16][16], int column) {
    for (int lane = 0; lane < warp_lanes; ++lane)
      for (int r = 0; r < 2; ++r) {
        float first, second;
        unpack_halves(a[r][lane], first, second);
        double* const at = &left[fragment_row(lane) + 8 * r][column + fragment_column(lane)];
        at[0] = first, at[1] = second;
      }
  }
  static void place_b(Own<Half2> const& b, double (&right)[16][8], int row) {
    for (int lane = 0; lane < warp_lanes; ++lane) {
      float first, second;
      unpack_halves(b[lane], first, second);
      right[row + fragment_column(lane)][fragment_row(lane)] = first;
      right[row + fragment_column(lane) + 1][fragment_row(lane)] = second;
    }
  }
  static float toward_zero(double x) {
    float const nearest = static_cast<float>(x);
    bool const away = std::abs(double(nearest)) > std::abs(x);
    return Lane::from_bits(Lane::bits({nearest}) - (away ? 1u : 0u)).v;  // a float's bits grow with its magnitude
  }
  template <int K>
  static void add_product(double const (&left)[16][16], double const (&right)[16][8], Own<Accumulator>& c) {
    double sum[16][8];
    for (int lane = 0; lane < warp_lanes; ++lane)
      for (int i = 0; i < 4; ++i) sum[fragment_row(lane) + i / 2 * 8][fragment_column(lane) + i % 2] = c[lane].v[i];
    for (int row = 0; row < 16; ++row)
      for (int k = 0; k < K; ++k)
        for (int column = 0; column < 8; ++column) sum[row][column] += left[row][k] * right[k][column];
    for (int lane = 0; lane < warp_lanes; ++lane)
      for (int i = 0; i < 4; ++i)
        c[lane].v[i] = toward_zero(sum[fragment_row(lane) + i / 2 * 8][fragment_column(lane) + i % 2]);
  }
};

// A block of lanes (mlp_fused.h) that are also warps.
struct LoopWarps : Lanes {
  using Warp = LoopWarp;
  template <class Step>
  void each_warp(Step const& step) const {
    for (int w = 0; w < lanes / warp_lanes; ++w) step(LoopWarp{}, w);
  }
};

}  // namespace scree::sdf_fused
