// tensor_test.cpp: the tensor core kernel: phi and gradient against the double reference, the fp16 filter against what
// it may reject.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/sdf/tensor_image.h"
#include "tests/support/network_bodies.h"
#include "tests/support/network_devices.h"

namespace scree {
namespace {

using namespace sdf_fused;
using test::activations;
using test::Bodies;
using test::random_mlp;
using test::widths;

double constexpr everywhere = -std::numeric_limits<double>::infinity(), nowhere = -everywhere;

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
