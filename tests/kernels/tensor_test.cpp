// tensor_test.cpp: the tensor core kernel: halves, fragment maps and packing against their definitions, phi and
// gradient against the double reference, the fp16 filter against what it may reject.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "kernels/sdf/tensor_image.h"
#include "tests/support/network_bodies.h"
#include "tests/support/network_devices.h"

namespace scree {
namespace {

using namespace sdf_fused;
using test::Bodies;
using test::random_mlp;
using test::widths;

double constexpr everywhere = -std::numeric_limits<double>::infinity(), nowhere = -everywhere;

std::vector<std::pair<Activation, double>> const activations = {
    {Activation::leaky_relu, 0.01}, {Activation::sine, 5.0}, {Activation::softplus, 20.0}};

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

// phi and gradient in double of the very float point the device evaluates; `kink`: how near a leaky ReLU is to its
// kink there, relative to what is summed.
struct Exact {
  double phi;
  Vec3 gradient;
  double kink = 1;
};
Exact exact(Bodies const& bodies, int body, Vec3 point) {
  int const s = bodies.shape_of[body];
  NetworkFrame const frame = network_frame(bodies.shape[s]);
  Mlp const& net = bodies.networks.net[bodies.shape[s].net].net();
  Exact e;
  Vec3 const x = to_double(to_network(frame, 0, point));
  e.phi = evaluate_reference(net, bodies.first_bias[s], x, &e.gradient) / frame.scale;
  e.gradient = transposed_times(frame.rotation, e.gradient);
  if (net.activation != Activation::leaky_relu) return e;
  std::vector<double> h = {x.x, x.y, x.z};
  for (int l = 0; l + 1 < net.layers(); ++l) {
    std::vector<double> next(net.width[l + 1]);
    for (int j = 0; j < net.width[l + 1]; ++j) {
      double z = l == 0 ? bodies.first_bias[s][j] : net.bias[l][j], size = std::abs(z);
      for (std::size_t k = 0; k < h.size(); ++k) {
        double const term = net.weight[l][k * net.width[l + 1] + j] * h[k];
        z += term, size += std::abs(term);
      }
      e.kink = std::min(e.kink, std::abs(z) / size);
      next[j] = z > 0 ? z : net.parameter * z;
    }
    h = std::move(next);
  }
  return e;
}

struct Errors {
  double phi = 0, gradient = 0;  // largest [d], [relative to the largest gradient]
  int compared = 0, of = 0;      // gradients away from kinks
};
Errors errors(Bodies const& bodies, QueryBatch const& found) {
  Errors e;
  double largest = 0;
  for (std::size_t i = 0; i < found.point.size(); ++i) {
    if (norm(found.point[i]) > 0.6) continue;
    Exact const x = exact(bodies, found.partner[i], found.point[i]);
    e.phi = std::max(e.phi, std::abs(found.phi[i] - x.phi));
    ++e.of;
    if (x.kink < 1e-6) continue;  // float rounding decides which side of the kink a point is on
    ++e.compared;
    e.gradient = std::max(e.gradient, norm(found.gradient[i] - x.gradient));
    largest = std::max(largest, norm(x.gradient));
  }
  e.gradient /= largest;
  return e;
}

class TensorTest : public testing::OnNetworkDevices {
 protected:
  QueryBatch evaluated(Bodies const& bodies, QueryBatch batch, Precision precision, double gradient_from) {
    device_->load(bodies.view(), bodies.networks, precision);
    device_->evaluate({}, batch, gradient_from);
    return batch;
  }
};

// 1e-6 d is the bar; random networks of eight layers come within a few roundings of it in fp32, too.
TEST_P(TensorTest, Fp16x3IsAsGoodAsFp32ForEveryActivationWidthAndDepth) {
  for (auto [activation, parameter] : activations) {
    double worst = 0, worst_fp32 = 0;
    for (int width : {16, 30, 40, 48, 64})
      for (int depth : {1, 3, 8}) {
        SCOPED_TRACE(std::string(to_string(activation)) + " " + std::to_string(depth) + " x " + std::to_string(width));
        Bodies bodies;
        bodies.add(random_mlp(activation, parameter, widths(3, width, depth), width + depth), 1);
        QueryBatch const asked = bodies.queries(70);
        Errors const x3 = errors(bodies, evaluated(bodies, asked, Precision::fp16x3, everywhere));
        Errors const fp32 = errors(bodies, evaluated(bodies, asked, Precision::fp32, everywhere));
        EXPECT_LE(x3.phi, 1e-6);
        EXPECT_LE(x3.gradient, 3e-6);
        EXPECT_LE(x3.phi, 4 * fp32.phi + 1e-7);
        EXPECT_GT(x3.compared, x3.of * 9 / 10);
        worst = std::max(worst, x3.phi), worst_fp32 = std::max(worst_fp32, fp32.phi);
      }
    EXPECT_LE(worst, 2 * worst_fp32);
    RecordProperty(std::string(to_string(activation)) + "_phi_1e-9", static_cast<int>(1e9 * worst));
  }
}

// Networks of several classes, codes that alternate within a tile; counts round the sizes of groups and tiles. A point
// has the same bits wherever it stands and whether its gradient is made or not.
TEST_P(TensorTest, BitsOfAPointDependOnNothingElse) {
  Bodies bodies;
  bodies.add(random_mlp(Activation::sine, 5, {13, 40, 40, 40, 1}, 1), 3);
  bodies.add(random_mlp(Activation::leaky_relu, 0.01, {3, 40, 17, 64, 8, 33, 1}, 2), 1);
  bodies.add(random_mlp(Activation::sine, 5, {3, 30, 30, 1}, 3), 1);
  bodies.add(random_mlp(Activation::softplus, 20, {5, 38, 39, 1}, 4), 2);
  for (Precision precision : {Precision::fp16x3, Precision::fast})
    for (int each : {0, 1, 16, tile_points / 3 + 1}) {
      if (precision == Precision::fast && each > 16) continue;  // the same text
      SCOPED_TRACE(each);
      QueryBatch const asked = bodies.queries(each);
      QueryBatch const plain = evaluated(bodies, asked, precision, everywhere);
      QueryBatch turned = asked;
      for (std::size_t net = 0; net < bodies.networks.net.size(); ++net) {
        std::reverse(turned.point.begin() + turned.group[net], turned.point.begin() + turned.group[net + 1]);
        std::reverse(turned.partner.begin() + turned.group[net], turned.partner.begin() + turned.group[net + 1]);
      }
      turned = evaluated(bodies, turned, precision, everywhere);
      QueryBatch const phi_only = evaluated(bodies, asked, precision, nowhere);
      for (std::size_t net = 0; net < bodies.networks.net.size(); ++net)
        for (int i = asked.group[net]; i < asked.group[net + 1]; ++i) {
          int const there = asked.group[net] + asked.group[net + 1] - 1 - i;
          ASSERT_EQ(plain.phi[i], turned.phi[there]);
          ASSERT_EQ(plain.phi[i], phi_only.phi[i]);
          ASSERT_EQ(plain.gradient[i], turned.gradient[there]);
          ASSERT_EQ(phi_only.gradient[i].x, 77) << "nobody asked for gradients";
        }
      if (each == 16) {
        EXPECT_LE(errors(bodies, plain).phi, precision == Precision::fast ? 5e-3 : 1e-6);
      }
    }
}

// What fp16 rejects is outside; it keeps an upper bound of phi that is no more than twice the filter's bound too high.
// All else has the bits of a run without a filter. Points lie within 2e-2 d of the surface.
TEST_P(TensorTest, TheFilterRejectsNothingThatIsInside) {
  int constexpr each = 3'000;
  for (auto [activation, parameter] : activations) {
    SCOPED_TRACE(to_string(activation));
    Bodies bodies;
    bodies.add(random_mlp(activation, parameter, {7, 40, 40, 40, 40, 40, 1}, 11), 4);
    bodies.add(random_mlp(activation, parameter, {3, 30, 30, 30, 1}, 12), 1);
    QueryBatch near = bodies.queries(1);
    auto const towards = test::random_points(each, 0.3, 9);
    std::vector<Vec3> point;
    std::vector<int> partner, group{0};
    for (std::size_t net = 0; net < bodies.networks.net.size(); ++net) {
      for (std::size_t b = 0; b < bodies.shape_of.size(); ++b) {
        if (bodies.shape[b].net != static_cast<int>(net)) continue;
        for (int k = 0; k < each / 5; ++k) {  // two Newton steps to a level of phi, of the host's
          point.push_back(to_double(towards[k]));
          partner.push_back(static_cast<int>(b));
        }
      }
      group.push_back(static_cast<int>(point.size()));
    }
    near.point = point, near.partner = partner;
    for (std::size_t g = 0; g < near.group.size(); ++g)
      near.group[g] = g < group.size() ? group[g] : static_cast<int>(point.size());
    for (int step = 0; step < 4; ++step) {
      near.phi.assign(point.size(), 0), near.gradient.assign(point.size(), {});
      evaluate_phi_gradient({}, bodies.view(), bodies.networks, near);
      if (step == 3) break;
      for (std::size_t i = 0; i < point.size(); ++i) {
        double const level = 0.02 * (std::fmod(0.6180339887498949 * i, 1.0) * 2 - 1);
        Vec3 const g = near.gradient[i];
        Vec3 const moved = near.point[i] + g * ((level - near.phi[i]) / std::max(norm2(g), 1e-2));
        if (norm(moved) < 0.6) near.point[i] = moved;
      }
    }
    QueryBatch const full = evaluated(bodies, near, Precision::fp16x3, everywhere);
    QueryBatch filtered = near;
    filtered.gradient.assign(point.size(), {77, 77, 77});
    filtered = evaluated(bodies, filtered, Precision::fp16x3, 0);
    auto const tensors = make_tensor_image(bodies.view(), make_network_image(bodies.view(), bodies.networks));
    int inside = 0, rejected = 0, close = 0;
    double most = 0;  // error of fp16 as a share of the filter's bound
    for (std::size_t i = 0; i < point.size(); ++i) {
      double const bound = tensors[bodies.shape[partner[i]].net].net[0].filter_bound / 1.3;
      close += std::abs(full.phi[i]) < 2e-2;
      if (full.phi[i] > 0) {
        ASSERT_EQ(filtered.phi[i], full.phi[i]) << "point " << i;
        ASSERT_EQ(filtered.gradient[i], full.gradient[i]) << "point " << i;
        ++inside;
      } else if (filtered.phi[i] != full.phi[i]) {
        ASSERT_LE(filtered.phi[i], 0) << "point " << i;
        ASSERT_GE(filtered.phi[i], full.phi[i]) << "point " << i;
        ASSERT_LE(filtered.phi[i], full.phi[i] + 2 * bound) << "point " << i;
        most = std::max(most, std::abs(filtered.phi[i] - bound - full.phi[i]) / bound);
        ++rejected;
      }
    }
    EXPECT_GT(close, each / 2);
    EXPECT_GT(inside, each / 10);
    EXPECT_GT(rejected, each / 10);
    EXPECT_GT(most, 0.05) << "the bound is far above anything seen";
    EXPECT_LT(most, 0.6) << "the margin is used up";
    RecordProperty(std::string(to_string(activation)) + "_percent_of_bound", static_cast<int>(100 * most));
  }
}

// One pass of fp16 is coarser than fp32 and is meant to be; with one hidden layer no half is involved at all.
TEST_P(TensorTest, FastIsWhatHalfPrecisionGives) {
  for (auto [activation, parameter] : activations)
    for (int depth : {1, 5}) {
      Bodies bodies;
      bodies.add(random_mlp(activation, parameter, widths(3, 40, depth), depth), 1);
      Errors const e = errors(bodies, evaluated(bodies, bodies.queries(70), Precision::fast, everywhere));
      EXPECT_LE(e.phi, depth == 1 ? 1e-6 : 5e-3);
      EXPECT_GE(e.phi, depth == 1 ? 0 : 1e-5);
    }
}

// Scales: weights and activations far from one, in every direction; and what no scale helps is refused by name.
TEST_P(TensorTest, ScalesKeepSmallAndLargeNumbersExact) {
  for (auto [activation, parameter] : activations)
    for (int exponent : {-18, 0, 18}) {
      SCOPED_TRACE(std::string(to_string(activation)) + " 2^" + std::to_string(exponent));
      Mlp net = random_mlp(activation, parameter, {3, 40, 40, 40, 1}, 3);
      // The same function up to rounding: leaky ReLU commutes with the factor; others have it in the last layer alone.
      if (activation == Activation::leaky_relu)
        for (float& w : net.weight[1]) w = std::ldexp(w, exponent);
      if (activation == Activation::leaky_relu)
        for (float& b : net.bias[1]) b = std::ldexp(b, exponent);
      if (activation == Activation::leaky_relu)
        for (float& w : net.weight[2]) w = std::ldexp(w, -exponent);
      Bodies bodies;
      bodies.add(net, 1);
      Errors const e = errors(bodies, evaluated(bodies, bodies.queries(70), Precision::fp16x3, everywhere));
      EXPECT_LE(e.phi, 1e-6);
      EXPECT_LE(e.gradient, 3e-6);
    }
  Mlp huge = random_mlp(Activation::softplus, 20, {3, 16, 16, 1}, 3);
  for (float& b : huge.bias[0]) b = 1e4f;
  Bodies bodies;
  bodies.add(huge, 1);
  EXPECT_THROW(device_->load(bodies.view(), bodies.networks, Precision::fp16x3), std::invalid_argument);
  EXPECT_NO_THROW(device_->load(bodies.view(), bodies.networks, Precision::fp32));
}

INSTANTIATE_TEST_SUITE_P(Devices, TensorTest, testing::network_devices, testing::network_device_name);

}  // namespace
}  // namespace scree
