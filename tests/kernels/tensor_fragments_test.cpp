// tensor_fragments_test.cpp: what tensor cores are fed, against its definition: halves, fragment maps, packed weights.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "kernels/sdf/tensor_image.h"
#include "tests/support/network_bodies.h"

namespace scree {
namespace {

using namespace sdf_fused;
using test::activations;
using test::Bodies;
using test::random_mlp;
using test::widths;

TEST(Halves, RoundToTheNearestAndTiesToEven) {
  for (std::uint32_t h = 0; h < 0x7c00u; ++h) {
    float const value = half_value(h), next = h + 1 < 0x7c00u ? half_value(h + 1) : 65536.0f;
    ASSERT_EQ(half_bits(value), h);
    ASSERT_EQ(half_bits(-value), h | 0x8000u);
    float const middle = (value + next) / 2;  // exact: halves have 11 bits
    ASSERT_EQ(half_bits(middle), h % 2 ? h + 1 : h);
    ASSERT_EQ(half_bits(std::nextafter(middle, 0.0f)), h);
    ASSERT_EQ(half_bits(std::nextafter(middle, 1e9f)), h + 1);
  }
  EXPECT_EQ(half_value(0x3c00u), 1.0f);
  EXPECT_EQ(half_value(1u), std::ldexp(1.0f, -24));
  EXPECT_TRUE(std::isnan(half_value(half_bits(std::nanf("")))));
  EXPECT_TRUE(std::isinf(half_value(half_bits(1e30f))));
}

TEST(Halves, TwoKeep22BitsOfAFloat) {
  double largest = 0;
  for (int i = 0; i < 200'000; ++i) {
    // All binades in which the low part is a normal half, and some below; mantissas by the golden ratio.
    int const exponent = i % 25 - 10;
    float const x = std::ldexp(1 + static_cast<float>(std::fmod(0.6180339887498949 * i, 1.0)), exponent);
    Half2 high, low;
    split_halves(x, -x, high, low);
    float h[2], l[2];
    unpack_halves(high, h[0], h[1]), unpack_halves(low, l[0], l[1]);
    double const error = std::abs(double(x) - h[0] - l[0]);
    ASSERT_EQ(h[0], -h[1]);
    ASSERT_LE(error, exponent >= -3 ? std::ldexp(double(x), -22) : std::ldexp(1.0, -25)) << x;
    largest = std::max(largest, exponent >= -3 ? error / x : 0.0);
  }
  EXPECT_GT(largest, std::ldexp(1.0, -24)) << "two halves cannot hold all of a float";
}

// Elements of mma.m16n8k16's and m16n8k8's fragments as the PTX ISA (8.x, section 9.7.14.5) lists them; i: the
// element's number in the fragment, groupID = lane / 4, threadID_in_group = lane % 4.
int a_row(int lane, int i, bool k16) { return lane / 4 + ((k16 ? i % 4 : i) < 2 ? 0 : 8); }
int a_column(int lane, int i) { return lane % 4 * 2 + i % 2 + (i < 4 ? 0 : 8); }
int b_row(int lane, int i) { return lane % 4 * 2 + i % 2 + (i < 2 ? 0 : 8); }
int b_column(int lane) { return lane / 4; }
int c_row(int lane, int i) { return lane / 4 + (i < 2 ? 0 : 8); }
int c_column(int lane, int i) { return lane % 4 * 2 + i % 2; }

// How many elements of C + A B a warp gets wrong, all numbers small integers, for 16 or 8 columns of A.
template <class Warp>
int wrong_elements(int k) {
  auto const a_at = [](int row, int column) { return static_cast<float>((3 * row + 5 * column) % 11 - 5); };
  auto const b_at = [](int row, int column) { return static_cast<float>((7 * row + 2 * column) % 13 - 6); };
  auto const c_at = [](int row, int column) { return static_cast<float>(100 * row + column); };
  using Words = typename Warp::template Own<Half2>;
  Words a[2][2], b[2];
  typename Warp::template Own<Accumulator> c;
  for (int lane = 0; lane < 32; ++lane) {
    for (int word = 0; word < k / 4; ++word) {
      int const i = 2 * word;
      a[word / 2][word % 2][lane] = pack_halves(a_at(a_row(lane, i, k == 16), a_column(lane, i)),
                                                a_at(a_row(lane, i + 1, k == 16), a_column(lane, i + 1)));
    }
    for (int word = 0; word < k / 8; ++word)
      b[word][lane] =
          pack_halves(b_at(b_row(lane, 2 * word), b_column(lane)), b_at(b_row(lane, 2 * word + 1), b_column(lane)));
    for (int i = 0; i < 4; ++i) c[lane].v[i] = c_at(c_row(lane, i), c_column(lane, i));
  }
  if (k == 16)
    Warp().multiply_16(c, a[0], a[1], b[0], b[1]);
  else
    Warp().multiply_8(c, a[0], b[0]);
  int wrong = 0;
  for (int lane = 0; lane < 32; ++lane)
    for (int i = 0; i < 4; ++i) {
      int const row = c_row(lane, i), column = c_column(lane, i);
      float expected = c_at(row, column);
      for (int j = 0; j < k; ++j) expected += a_at(row, j) * b_at(j, column);
      wrong += c[lane].v[i] != expected;
    }
  return wrong;
}

// Maps with one mistake each; the check has to see all of them.
struct RowsSwapped : LoopWarp {
  void multiply_16(Own<Accumulator>& c, Own<Half2> const (&a)[2], Own<Half2> const (&next)[2], Own<Half2> const& b,
                   Own<Half2> const& b_next) const {
    Own<Half2> const swapped[2] = {a[1], a[0]};
    LoopWarp::multiply_16(c, swapped, next, b, b_next);
  }
  void multiply_8(Own<Accumulator>& c, Own<Half2> const (&a)[2], Own<Half2> const& b) const {
    Own<Half2> const swapped[2] = {a[1], a[0]};
    LoopWarp::multiply_8(c, swapped, b);
  }
};
struct BlocksSwapped : LoopWarp {
  void multiply_16(Own<Accumulator>& c, Own<Half2> const (&a)[2], Own<Half2> const (&next)[2], Own<Half2> const& b,
                   Own<Half2> const& b_next) const {
    LoopWarp::multiply_16(c, a, next, b_next, b);
  }
};

TEST(Fragments, ProductsOfIntegersAreThoseOfPlainMatrices) {
  for (int k : {16, 8}) {
    EXPECT_EQ(wrong_elements<LoopWarp>(k), 0);
    EXPECT_GT(wrong_elements<RowsSwapped>(k), 100);
  }
  EXPECT_GT(wrong_elements<BlocksSwapped>(16), 100);
}

// Every weight is found again in the word and half that the lane which multiplies by it reads, to 2^-22 of itself, and
// every word holds two weights.
TEST(Fragments, PackedWeightsAreFoundWhereTheirLaneReadsThem) {
  for (auto [activation, parameter] : activations)
    for (int w : {16, 32, 40, 48, 64}) {
      Bodies bodies;
      bodies.add(random_mlp(activation, parameter, widths(3, w - 1, 3), w), 1);  // a padded neuron
      NetworkImage const image = make_network_image(bodies.view(), bodies.networks);
      TensorClass const tensors = make_tensor_image(bodies.view(), image)[0];
      TensorRecord const& record = tensors.net[0];
      NetworkClass const& of = image.classes[0];
      ASSERT_EQ(of.width, w);
      int const plane = w * w / 2, blocks = w / 8;
      ASSERT_EQ(tensors.word.size(), std::size_t(4 * 2 * plane));
      for (int layer = 0; layer < 4; ++layer) {  // forward 1, 2, backward 1, 2
        int const l = 1 + layer % 2;
        float const* const weight =
            of.weight.data() + of.net[0].first + (layer < 2 ? l : 3 + l) * w * w + (layer < 2 ? 0 : 3 * w);
        Half2 const* const high = tensors.word.data() + record.first_word + layer * 2 * plane;
        std::set<int> used;
        double largest = 0, ratio = 0;
        for (int i = 0; i < w * w; ++i) largest = std::max<double>(largest, std::abs(weight[i]));
        int exponent;
        std::frexp(largest, &exponent);
        for (int k = 0; k < w; ++k)
          for (int n = 0; n < w; ++n) {
            int const lane = n % 8 * 4 + k % 8 / 2;  // b_row, b_column the other way round
            int const at = fragment_word(blocks, n / 8, k / 8) + fragment_step(blocks, k / 8) * lane;
            used.insert(2 * at + k % 2);
            float h[2], low[2];
            unpack_halves(high[at], h[0], h[1]), unpack_halves(high[at + plane], low[0], low[1]);
            double const found = std::ldexp(double(h[k % 2]) + low[k % 2], exponent - 15), w0 = weight[k * w + n];
            ASSERT_NEAR(found, w0, std::ldexp(std::max(std::abs(w0), largest * std::ldexp(1.0, -17)), -22));
            ratio = std::max(ratio, std::abs(h[k % 2]) / 32768.0);
          }
        EXPECT_EQ(used.size(), std::size_t(w * w));
        EXPECT_EQ(*used.rbegin(), w * w - 1);
        EXPECT_GE(ratio, 0.5) << "the largest weight fills the range";
      }
    }
}

}  // namespace
}  // namespace scree
