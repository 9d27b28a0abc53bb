// sdf_batch_test.cpp: the SIMD evaluator against the double reference, bit for bit independence of the batch, errors.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/sdf_batch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>

#include "kernels/base/profile.h"
#include "tests/support/random_mlp.h"

namespace scree {
namespace {

using test::random_code;
using test::random_mlp;
using test::random_points;

double constexpr tolerance = 1e-5;  // promised by sdf_batch.h, of the network's unit; float rounding gives about 1e-6

// Runs the body with one instruction set, through the same variable a user has.
class SdfBatch : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { setenv("SCREE_ISA", GetParam().c_str(), 1); }
  void TearDown() override { unsetenv("SCREE_ISA"); }
};

struct Result {
  std::vector<float> phi;
  std::vector<Vec3f> gradient;
};

Result evaluate(PackedMlp const& net, std::vector<float> const& rows, std::vector<Vec3f> const& point,
                std::vector<int> const& row = {}, int threads = 1) {
  Queue queue;
  queue.threads = threads;
  Result r;
  r.phi.resize(point.size());
  r.gradient.resize(point.size());
  std::vector<float> phi_alone(point.size());
  sdf_forward_gradient(queue, net, rows, point, row, r.phi, r.gradient);
  sdf_forward(queue, net, rows, point, row, phi_alone);
  EXPECT_EQ(std::vector<std::uint32_t>(reinterpret_cast<std::uint32_t*>(r.phi.data()),
                                       reinterpret_cast<std::uint32_t*>(r.phi.data()) + r.phi.size()),
            std::vector<std::uint32_t>(reinterpret_cast<std::uint32_t*>(phi_alone.data()),
                                       reinterpret_cast<std::uint32_t*>(phi_alone.data()) + phi_alone.size()))
      << "the two functions give different bits";
  return r;
}

bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
bool same_bits(Vec3f a, Vec3f b) { return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z); }

std::vector<int> widths(int inputs, int hidden, int layers) {
  std::vector<int> w{inputs};
  w.insert(w.end(), layers, hidden);
  w.push_back(1);
  return w;
}

// Every point against the reference. The gradient's error is measured against the largest gradient of the batch: at a
// single point of a random network it may cancel. LeakyReLU has kinks, where either side's gradient is right: a point
// is let off when the reference's own gradient differs from it a float's rounding away, and such points must be rare.
void expect_reference(Mlp const& mlp, std::vector<Vec3f> const& point, std::vector<float> const& code) {
  PackedMlp const net(mlp);
  auto const bias = fold_code(mlp, code);
  std::vector<float> rows;
  net.append_bias(bias, rows);
  Result const r = evaluate(net, rows, point);
  std::vector<Vec3> gradient(point.size());
  double largest = 0;
  int kinks = 0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    double const phi = evaluate_reference(mlp, bias, to_double(point[i]), &gradient[i]);
    largest = std::max(largest, norm(gradient[i]));
    ASSERT_LT(std::abs(phi), 20) << "not a network of order one";
    ASSERT_NEAR(r.phi[i], phi, tolerance * std::max(1.0, std::abs(phi))) << "point " << i;
  }
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (norm(to_double(r.gradient[i]) - gradient[i]) <= 2 * tolerance * largest) continue;
    ASSERT_EQ(mlp.activation, Activation::leaky_relu) << "gradient of point " << i;
    ++kinks;
    bool explained = false;
    for (int k = 0; k < 6 && !explained; ++k) {
      Vec3 near = to_double(point[i]), other;
      near[k % 3] += k < 3 ? 3e-6 : -3e-6;
      evaluate_reference(mlp, bias, near, &other);
      explained = norm(other - gradient[i]) > 2 * tolerance * largest;
    }
    ASSERT_TRUE(explained) << "gradient of point " << i;
  }
  EXPECT_LE(kinks, static_cast<int>(point.size()) / 50);
}

TEST_P(SdfBatch, EqualsReferenceAtEveryWidthAndDepth) {
  auto const point = random_points(60, 0.8, 1);
  for (int width : {8, 9, 16, 30, 32, 40, 48, 50, 63, 64})
    for (int depth = 1; depth <= 6; ++depth)
      for (auto [activation, parameter] : {std::pair(Activation::leaky_relu, 0.01), std::pair(Activation::sine, 5.0),
                                           std::pair(Activation::softplus, 20.0)}) {
        SCOPED_TRACE(std::string(to_string(activation)) + " " + std::to_string(depth) + " x " + std::to_string(width));
        expect_reference(random_mlp(activation, parameter, widths(3, width, depth), 100 * width + depth), point, {});
      }
}

TEST_P(SdfBatch, EqualsReferenceWithOtherParametersCodesAndUnequalWidths) {
  auto const point = random_points(500, 0.8, 2);
  for (auto [activation, parameter] :
       {std::pair(Activation::leaky_relu, 0.0), std::pair(Activation::leaky_relu, 0.2),
        std::pair(Activation::leaky_relu, 1.0), std::pair(Activation::sine, 1.0), std::pair(Activation::sine, 30.0),
        std::pair(Activation::softplus, 1.0), std::pair(Activation::softplus, 100.0)}) {
    SCOPED_TRACE(std::string(to_string(activation)) + " " + std::to_string(parameter));
    expect_reference(random_mlp(activation, parameter, {13, 40, 17, 64, 8, 33, 1}, 5), point, random_code(10, 3));
  }
}

// sin itself, through a network that is nothing else: phi = sin(omega x).
TEST_P(SdfBatch, SineIsAccurateForArgumentsOfHundreds) {
  Mlp mlp;
  mlp.activation = Activation::sine;
  mlp.parameter = 1;
  mlp.width = {3, 1, 1};
  mlp.weight = {{1, 0, 0}, {1}};
  mlp.bias = {{0}, {0}};
  PackedMlp const net(mlp);
  std::vector<float> rows;
  net.append_bias(mlp.bias[0], rows);
  std::vector<Vec3f> point;
  for (int i = -40000; i <= 40000; ++i) point.push_back({0.01f * i, 0, 0});
  Result const r = evaluate(net, rows, point);
  for (std::size_t i = 0; i < point.size(); ++i) {
    double const x = point[i].x;
    // 2e-7 of the polynomial and its rounding; 1.2e-7 |x| because x omega / pi is rounded twice.
    ASSERT_NEAR(r.phi[i], std::sin(x), 2e-7 + 1.2e-7 * std::abs(x)) << x;
    ASSERT_NEAR(r.gradient[i].x, std::cos(x), 3e-7 + 1.2e-7 * std::abs(x)) << x;
  }
}

TEST_P(SdfBatch, GradientIsTheSlopeOfPhi) {
  // Central differences of the double reference: truncation h^2/6 |phi'''| and cancellation 1e-16 / h.
  double const h = 1e-4;
  Mlp const mlp = random_mlp(Activation::sine, 3, widths(3, 40, 3), 9);
  PackedMlp const net(mlp);
  std::vector<float> rows;
  net.append_bias(mlp.bias[0], rows);
  auto const point = random_points(100, 0.5, 10);
  Result const r = evaluate(net, rows, point);
  for (std::size_t i = 0; i < point.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      Vec3 up = to_double(point[i]), down = up;
      up[c] += h;
      down[c] -= h;
      double const slope =
          (evaluate_reference(mlp, mlp.bias[0], up) - evaluate_reference(mlp, mlp.bias[0], down)) / (2 * h);
      EXPECT_NEAR(r.gradient[i][c], slope, 1e-5 * std::max(1.0, std::abs(slope)));
    }
}

// One point alone is the yardstick; then every batch size round the block sizes 8, 24 and 48, every position in it,
// other neighbours, other threads.
TEST_P(SdfBatch, SameBitsAtAnyPositionBatchSizeAndThreadCount) {
  for (auto [activation, parameter] : {std::pair(Activation::leaky_relu, 0.01), std::pair(Activation::sine, 5.0),
                                       std::pair(Activation::softplus, 20.0)}) {
    SCOPED_TRACE(to_string(activation));
    Mlp const mlp = random_mlp(activation, parameter, widths(3, 40, 5), 11);
    PackedMlp const net(mlp);
    std::vector<float> rows;
    net.append_bias(mlp.bias[0], rows);
    auto const point = random_points(5000, 0.8, 12);
    Result const whole = evaluate(net, rows, point);
    for (int threads : {2, 3, 4}) {
      Result const again = evaluate(net, rows, point, {}, threads);
      for (std::size_t i = 0; i < point.size(); ++i) {
        ASSERT_TRUE(same_bits(whole.phi[i], again.phi[i])) << threads << " threads, point " << i;
        ASSERT_TRUE(same_bits(whole.gradient[i], again.gradient[i])) << threads << " threads, point " << i;
      }
    }
    for (int n : {0, 1, 7, 8, 9, 23, 24, 25, 47, 48, 49, 1000})
      for (int first : {0, 1, 5, 77}) {
        Result const part = evaluate(net, rows, {point.begin() + first, point.begin() + first + n});
        for (int i = 0; i < n; ++i) {
          ASSERT_TRUE(same_bits(part.phi[i], whole.phi[first + i])) << n << " points from " << first;
          ASSERT_TRUE(same_bits(part.gradient[i], whole.gradient[first + i])) << n << " points from " << first;
        }
      }
  }
}

// Many shapes of one decoder in one batch: runs of equal rows, changes inside a block, and alternation give the bits
// that each shape has alone.
TEST_P(SdfBatch, MixedBiasRowsGiveTheBitsOfEachRowAlone) {
  for (auto [activation, parameter] : {std::pair(Activation::leaky_relu, 0.01), std::pair(Activation::sine, 5.0)}) {
    Mlp const mlp = random_mlp(activation, parameter, widths(13, 30, 4), 21);
    PackedMlp const net(mlp);
    int constexpr n = 700, shapes = 5;
    auto const point = random_points(n, 0.8, 22);
    std::vector<float> rows;
    std::vector<Result> alone;
    for (int s = 0; s < shapes; ++s) {
      auto const bias = fold_code(mlp, random_code(10, 30 + s));
      EXPECT_EQ(net.append_bias(bias, rows), s);
      std::vector<float> own;
      net.append_bias(bias, own);
      alone.push_back(evaluate(net, own, point));
    }
    ASSERT_FALSE(same_bits(alone[0].phi[0], alone[1].phi[0])) << "the codes must matter for this test to mean anything";
    for (int run : {1, 2, 10, 100}) {
      std::vector<int> row(n);
      for (int i = 0; i < n; ++i) row[i] = i / run % shapes;
      for (int threads : {1, 2}) {
        Result const mixed = evaluate(net, rows, point, row, threads);
        for (int i = 0; i < n; ++i) {
          ASSERT_TRUE(same_bits(mixed.phi[i], alone[row[i]].phi[i])) << "runs of " << run << ", point " << i;
          ASSERT_TRUE(same_bits(mixed.gradient[i], alone[row[i]].gradient[i])) << "runs of " << run << ", point " << i;
        }
      }
    }
  }
}

TEST_P(SdfBatch, WritesNothingBeyondItsOutputs) {
  Mlp const mlp = random_mlp(Activation::leaky_relu, 0.01, widths(3, 40, 2), 40);
  PackedMlp const net(mlp);
  std::vector<float> rows;
  net.append_bias(mlp.bias[0], rows);
  for (int n : {0, 1, 23, 25}) {
    auto const point = random_points(n, 0.5, 41);
    std::vector<float> phi(n + 64, -7.0f);
    std::vector<Vec3f> gradient(n + 64, {-7, -7, -7});
    sdf_forward_gradient({}, net, rows, point, {}, {phi.data(), n}, {gradient.data(), n});
    for (int i = n; i < n + 64; ++i) {
      ASSERT_EQ(phi[i], -7.0f);
      ASSERT_EQ(gradient[i], (Vec3f{-7, -7, -7}));
    }
  }
}

// A lost body must show: NaN in, NaN out, and only there.
TEST_P(SdfBatch, NotANumberStaysInItsLane) {
  for (auto [activation, parameter] : {std::pair(Activation::leaky_relu, 0.01), std::pair(Activation::sine, 5.0),
                                       std::pair(Activation::softplus, 20.0)}) {
    SCOPED_TRACE(to_string(activation));
    Mlp const mlp = random_mlp(activation, parameter, widths(3, 16, 2), 50);
    PackedMlp const net(mlp);
    std::vector<float> rows;
    net.append_bias(mlp.bias[0], rows);
    auto point = random_points(30, 0.5, 51);
    point[11].y = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> phi(30);
    sdf_forward({}, net, rows, point, {}, phi);
    for (int i = 0; i < 30; ++i) EXPECT_EQ(std::isnan(phi[i]), i == 11) << i;
  }
}

TEST_P(SdfBatch, NamesAndTimesItself) {
  EXPECT_EQ(sdf_isa(), GetParam());
  Mlp const mlp = random_mlp(Activation::leaky_relu, 0.01, widths(3, 8, 1), 60);
  PackedMlp const net(mlp);
  std::vector<float> rows;
  net.append_bias(mlp.bias[0], rows);
  Profile profile;
  Queue queue;
  queue.profile = &profile;
  auto const point = random_points(30, 0.5, 61);
  std::vector<float> phi(30);
  std::vector<Vec3f> gradient(30);
  sdf_forward(queue, net, rows, point, {}, phi);
  sdf_forward_gradient(queue, net, rows, point, {}, phi, gradient);
  sdf_forward(queue, net, rows, {}, {}, {});  // nothing to do is legal and not counted
  ASSERT_EQ(profile.entries().size(), 2u);
  EXPECT_EQ(profile.entries()[0].name, "sdf_net/forward");
  EXPECT_EQ(profile.entries()[0].items, 30);
  EXPECT_EQ(profile.entries()[0].calls, 1);
  EXPECT_EQ(profile.entries()[1].name, "sdf_net/gradient");
}

TEST_P(SdfBatch, RefusesBadInput) {
  Mlp const good = random_mlp(Activation::leaky_relu, 0.01, widths(3, 40, 2), 70);
  auto const refused = [&](auto const& change) {
    Mlp bad = good;
    change(bad);
    EXPECT_THROW(PackedMlp{bad}, std::invalid_argument);
  };
  refused([](Mlp& m) { m.width = {3, 1}, m.weight = {{1, 1, 1}}, m.bias = {{0}}; });
  refused([](Mlp& m) { m = random_mlp(Activation::leaky_relu, 0.01, widths(3, 65, 2), 1); });
  refused([](Mlp& m) { m.weight[1][3] = std::numeric_limits<float>::quiet_NaN(); });
  refused([](Mlp& m) { m.weight[1].pop_back(); });
  refused([](Mlp& m) { m.parameter = 1.5; });
  refused([](Mlp& m) { m.activation = Activation::sine, m.parameter = 0; });

  PackedMlp const net(good);
  EXPECT_GE(net.bias_stride(), 40);
  std::vector<float> rows, short_row(39);
  EXPECT_THROW(net.append_bias(short_row, rows), std::invalid_argument);
  net.append_bias(good.bias[0], rows);
  auto const point = random_points(10, 0.5, 71);
  std::vector<float> phi(10), nine(9);
  std::vector<Vec3f> gradient(9);
  std::vector<int> row(10, 0), outside(10, 0), negative(10, 0);
  outside[4] = 1;
  negative[9] = -1;
  Queue const queue;
  EXPECT_THROW(sdf_forward(queue, net, rows, point, {}, nine), std::invalid_argument);
  EXPECT_THROW(sdf_forward(queue, net, {}, point, {}, phi), std::invalid_argument);
  EXPECT_THROW(sdf_forward(queue, net, short_row, point, {}, phi), std::invalid_argument);
  EXPECT_THROW(sdf_forward(queue, net, rows, point, Span<const int>(row.data(), 9), phi), std::invalid_argument);
  EXPECT_THROW(sdf_forward(queue, net, rows, point, outside, phi), std::invalid_argument);
  EXPECT_THROW(sdf_forward(queue, net, rows, point, negative, phi), std::invalid_argument);
  EXPECT_THROW(sdf_forward_gradient(queue, net, rows, point, {}, phi, gradient), std::invalid_argument);
  EXPECT_NO_THROW(sdf_forward(queue, net, rows, point, row, phi));
  Queue device;
  device.backend = Backend::cuda;
  EXPECT_THROW(sdf_forward(device, net, rows, point, {}, phi), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Isa, SdfBatch, ::testing::ValuesIn(sdf_isas()), [](auto const& i) { return i.param; });

TEST(SdfIsa, UnknownNameIsRefusedWithTheOffer) {
  setenv("SCREE_ISA", "avx1024", 1);
  try {
    sdf_isa();
    ADD_FAILURE() << "accepted";
  } catch (std::invalid_argument const& e) {
    EXPECT_NE(std::string(e.what()).find("generic"), std::string::npos) << e.what();
  }
  unsetenv("SCREE_ISA");
  EXPECT_EQ(sdf_isa(), sdf_isas().front());
}

// Folding the code must equal the network with the code as further inputs, evaluated here by hand.
TEST(FoldCode, EqualsTheNetworkWithTheCodeAsInput) {
  Mlp const coded = random_mlp(Activation::sine, 2, {3 + 4, 8, 1}, 80);
  auto const code = random_code(4, 81);
  auto const bias = fold_code(coded, code);
  ASSERT_EQ(bias.size(), 8u);
  double const input[7] = {0.1, -0.2, 0.3, code[0], code[1], code[2], code[3]};
  double phi = coded.bias[1][0];
  for (int j = 0; j < 8; ++j) {
    double z = coded.bias[0][j];
    for (int k = 0; k < 7; ++k) z += coded.weight[0][k * 8 + j] * input[k];
    phi += coded.weight[1][j] * std::sin(2 * z);
  }
  // The folded bias is rounded to float once: 6e-8 of a number of order one, a few of them.
  EXPECT_NEAR(evaluate_reference(coded, bias, {0.1, -0.2, 0.3}), phi, 1e-6);
  EXPECT_EQ(fold_code(random_mlp(Activation::sine, 2, {3, 8, 1}, 82), {}),
            random_mlp(Activation::sine, 2, {3, 8, 1}, 82).bias[0]);
  EXPECT_THROW(fold_code(coded, {}), std::invalid_argument);
}

}  // namespace
}  // namespace scree
