// test_training.cpp: data sets, training, export and publication, on trainings of a second or two.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/training/training_bodies.h"
#include "training/decoder.h"
#include "training/pool.h"
#include "training/publish.h"
#include "training/train.h"

namespace scree {
namespace {

TEST(TrainingSamples, LieWhereTheOptionsSay) {
  Body const body = ellipsoid_body("e", {1.4, 1.1, 1});
  Samples const shell = shell_samples(body, 3000, 1, 2);
  double mean_cube = 0;
  for (Vec3 x : shell.point) {
    EXPECT_GE(norm(x), 0.9 * body.inscribed_radius * (1 - 1e-12));
    EXPECT_LE(norm(x), 1.1 * body.bounding_radius * (1 + 1e-12));
    mean_cube += std::pow(norm(x), 3) / 3000;
  }
  // Uniform in volume means r^3 uniform: mean in the middle, standard error of 3,000 draws (b - a) / sqrt(12 * 3000).
  double const a = std::pow(0.9 * body.inscribed_radius, 3), b = std::pow(1.1 * body.bounding_radius, 3);
  EXPECT_NEAR(mean_cube, (a + b) / 2, 5 * (b - a) / std::sqrt(12 * 3000.0));

  SamplingOptions options;
  options.count = 3000;
  Samples const training = training_samples(body, options, 1, 2);
  ASSERT_EQ(training.point.size(), 3000u);
  int near = 0, deep = 0;
  for (double phi : training.phi) {
    near += std::abs(phi) < 4 * options.band;
    deep += phi > 0.5 * body.inscribed_radius;
  }
  EXPECT_GT(near, options.share_surface * 3000 * 0.7);  // 68 % of the wide band, all of the narrow one
  EXPECT_GT(deep, 0);
}

TEST(TrainingSamples, SameForAnyNumberOfThreads) {
  Body const body = ellipsoid_body("e", {1.4, 1.1, 1});
  SamplingOptions options;
  options.count = 500;
  EXPECT_EQ(training_samples(body, options, 3, 1).phi, training_samples(body, options, 3, 2).phi);
  EXPECT_NE(training_samples(body, options, 3, 1).phi, training_samples(body, options, 4, 1).phi);
}

TEST(TrainingSamples, RefuseABodyThatIsNotNormalised) {
  TriangleMesh mesh = icosphere(2);  // radius 1 instead of 1/2
  EXPECT_THROW(make_body("big", mesh, ""), std::invalid_argument);
  mesh = normalised(mesh);
  mesh.triangle.pop_back();
  EXPECT_THROW(make_body("open", mesh, ""), std::invalid_argument);
}

// What the engine computes is what was trained: the scalar reference on exported weights against the LibTorch model.
class Export : public testing::TestWithParam<Activation> {};

TEST_P(Export, ReferenceEqualsTorch) {
  TrainOptions options = tiny_options();
  options.activation = GetParam();
  options.parameter = GetParam() == Activation::leaky_relu ? 0.01 : 5;
  options.layers = 4;
  options.width = 24;
  options.code_size = 3;
  int constexpr shapes = 2, rows = 100;
  Decoder const decoder(options, shapes);
  Samples samples;
  for (int i = 0; i < rows; ++i) {
    double const t = 0.37 * i;
    samples.point.push_back({0.8 * std::sin(t), 0.7 * std::cos(2.1 * t), 0.6 * std::sin(3.3 * t)});
    samples.phi.push_back(0);
    samples.gradient.push_back({1, 0, 0});
  }
  std::vector<SampleBlock> const blocks = make_blocks({samples, samples}, rows);
  ASSERT_EQ(blocks.size(), 1u);
  Decoder::Output const out = decoder.forward(blocks[0].point, blocks[0].gradient);
  Mlp const net = decoder.to_mlp();
  ASSERT_TRUE(problems(net).empty());
  for (int s = 0; s < shapes; ++s) {
    std::vector<float> const bias = fold_code(net, decoder.codes()[s]);
    for (int i = 0; i < rows; ++i) {
      Vec3 gradient;
      double const phi = evaluate_reference(net, bias, samples.point[i], &gradient);
      // float arithmetic over sums of 24 terms of order 1: about 24 * 6e-8 a layer.
      EXPECT_NEAR(out.phi[s][i].item<double>(), phi, 1e-5);
      EXPECT_NEAR(out.slope[s][i].item<double>(), gradient.x, 1e-4);
    }
  }
  EXPECT_EQ(decoder.forward(blocks[0].point, {}).phi.sub(out.phi).abs().max().item<double>(), 0);
}
INSTANTIATE_TEST_SUITE_P(Activations, Export,
                         testing::Values(Activation::sine, Activation::leaky_relu, Activation::softplus));

// The hand-written backward pass of the activation against central differences of the loss.
TEST_P(Export, GradientOfTheLossIsRight) {
  TrainOptions options = tiny_options();
  options.activation = GetParam();
  options.parameter = GetParam() == Activation::leaky_relu ? 0.1 : 5;
  options.width = 8;
  options.code_size = 2;
  Decoder const decoder(options, 1);
  Samples samples;
  for (int i = 0; i < 16; ++i) {
    samples.point.push_back({0.05 * i - 0.4, 0.3 * std::sin(i), 0.2 * std::cos(i)});
    samples.phi.push_back(0.1);
    samples.gradient.push_back(normalized(Vec3{std::cos(i), 1, std::sin(i)}));
  }
  SampleBlock const block = make_blocks({samples}, 16).front();
  auto const loss = [&] {
    Decoder::Output const out = decoder.forward(block.point, block.gradient);
    return (out.phi - block.phi).square().mean() + (out.slope - 1).square().mean();
  };
  std::vector<torch::Tensor> const gradient = decoder.gradients(loss());
  for (std::size_t l = 0; l < gradient.size(); ++l) {
    torch::NoGradGuard const guard;
    torch::Tensor const& leaf = decoder.leaves()[l];
    float* const value = leaf.data_ptr<float>() + leaf.numel() / 2;
    float const kept = *value, step = 3e-3F;
    *value = kept + step;
    double const up = loss().item<double>();
    *value = kept - step;
    double const down = loss().item<double>();
    *value = kept;
    double const expected = (up - down) / (2 * step);
    // Truncation step^2 and float rounding 1e-6 / step, on gradients of order 0.1 to 10.
    EXPECT_NEAR(gradient[l].reshape({-1})[leaf.numel() / 2].item<double>(), expected, 5e-3 * (1 + std::abs(expected)))
        << "leaf " << l;
  }
}

TEST(Train, LossFallsAndTheBestStateIsKept) {
  Body const body = ellipsoid_body("e", {1.4, 1.1, 1});
  std::vector<EpochRecord> seen;
  TrainedNet const trained = train({body}, tiny_options(), [&](EpochRecord const& r) { seen.push_back(r); });
  ASSERT_GE(trained.history.size(), 5u);
  EXPECT_EQ(seen.size(), trained.history.size());
  EXPECT_EQ(trained.history.back().step, 200);
  EXPECT_LT(trained.history.back().loss, 0.3 * trained.history.front().loss);
  double lowest = INFINITY;
  for (EpochRecord const& r : trained.history) lowest = std::min(lowest, r.mean_mae);
  EXPECT_DOUBLE_EQ(trained.mae[0], lowest);
  EXPECT_DOUBLE_EQ(trained.history[trained.best_epoch - 1].mean_mae, lowest);
  // 200 steps of a 2x16 net: an order of magnitude from the start, far from the 1e-3 of a full run.
  EXPECT_LT(lowest, 0.02);
  // The recorded error is that of the exported network.
  Samples const test = shell_samples(body, 2000, 99, 2);
  double mae = 0;
  for (std::size_t i = 0; i < test.point.size(); ++i)
    mae += std::abs(evaluate_reference(trained.net, fold_code(trained.net, {}), test.point[i]) - test.phi[i]) / 2000;
  EXPECT_NEAR(mae, lowest, 0.2 * lowest);  // two draws of 500 and 2,000 points
}

TEST(Train, SameBitsForAnyNumberOfThreadsAndAnotherSeedDiffers) {
  Body const body = ellipsoid_body("e", {1.2, 1.1, 1});
  TrainOptions options = tiny_options();
  options.steps = 20;
  options.threads = 1;
  TrainedNet const one = train({body}, options);
  options.threads = 2;
  TrainedNet const two = train({body}, options);
  EXPECT_EQ(one.net.weight, two.net.weight);
  EXPECT_EQ(one.mae, two.mae);
  options.seed = 2;
  EXPECT_NE(one.net.weight, train({body}, options).net.weight);
}

TEST(Train, CodesTellShapesApart) {
  std::vector<Body> const bodies = {ellipsoid_body("flat", {1.5, 1.5, 1}), ellipsoid_body("long", {1.8, 1, 1})};
  TrainOptions options = tiny_options();
  options.code_size = 2;
  options.steps = 400;
  TrainedNet const trained = train(bodies, options);
  ASSERT_EQ(trained.code.size(), 2u);
  ASSERT_EQ(trained.code[0].size(), 2u);
  EXPECT_LT(trained.mae[0], 0.02);
  EXPECT_LT(trained.mae[1], 0.02);
  // With the codes exchanged each shape has the other's error: their surfaces are 0.1 to 0.2 d apart.
  Samples const test = shell_samples(bodies[0], 500, 5, 2);
  double exchanged = 0;
  for (std::size_t i = 0; i < test.point.size(); ++i)
    exchanged += std::abs(evaluate_reference(trained.net, fold_code(trained.net, trained.code[1]), test.point[i]) -
                          test.phi[i]) /
                 500;
  EXPECT_GT(exchanged, 3 * trained.mae[0]);
}

TEST(Train, RefusesBadOptions) {
  Body const body = ellipsoid_body("e", {1.2, 1.1, 1}, 1);
  TrainOptions options = tiny_options();
  EXPECT_THROW(train({}, options), std::invalid_argument);
  EXPECT_THROW(train({body, body}, options), std::invalid_argument);  // two shapes, no code
  options.width = 65;
  options.steps = 0;
  try {
    train({body}, options);
    FAIL() << "width 65 and no steps were accepted";
  } catch (std::invalid_argument const& error) {
    EXPECT_NE(std::string(error.what()).find("width"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("steps"), std::string::npos);
  }
  options = tiny_options();
  options.rate = 1e30;
  EXPECT_THROW(train({body}, options), std::runtime_error);  // the loss does not stay finite
}

TEST(Publish, ShapesAreNormalisedAndMeasuredAgainstTheTruth) {
  std::vector<Body> const bodies = {ellipsoid_body("round", {1.2, 1.1, 1}), ellipsoid_body("long", {1.6, 1.2, 1})};
  TrainOptions options = tiny_options();
  options.code_size = 2;
  options.steps = 600;
  TrainedNet const trained = train(bodies, options);
  PublishOptions publish_options;
  publish_options.points = 3000;
  publish_options.cells = 32;
  publish_options.nodes = 300;
  Library const library = publish(trained, bodies, publish_options);
  ASSERT_EQ(library.shape.size(), 2u);
  EXPECT_TRUE(problems(library).empty());
  for (int s = 0; s < 2; ++s) {
    Certificate const& c = library.shape[s].certificate;
    EXPECT_EQ(library.shape[s].name, bodies[s].name);
    EXPECT_EQ(c.components, 1);
    EXPECT_EQ(c.euler, 2);
    // The same error as in training: normalising moves net and truth alike. Two draws of points.
    EXPECT_NEAR(c.mae, trained.mae[s], 0.25 * trained.mae[s]);
    EXPECT_GE(c.max, c.p99);
    EXPECT_GE(c.p99, c.mae);
    EXPECT_GT(c.gradient_p1, 0.3);
    EXPECT_LT(c.gradient_p99, 1.7);
    EXPECT_GT(c.normal_p95, c.normal_p50);
    // A volume error is about area * mean offset: 3.3 d^2 / 0.52 d^3 times at most the band's error.
    EXPECT_LT(c.volume_error, 8 * c.band_mae);
    EXPECT_GE(c.hausdorff, 0);
    EXPECT_LT(c.hausdorff, 0.2);
    EXPECT_GE(c.band_max, c.band_p99);
    EXPECT_GE(c.band_p99, c.band_mae);
    EXPECT_EQ(c.flat_share, 1);  // a smooth body has no edges
    EXPECT_EQ(c.flat_normal_p95, c.normal_p95);
    EXPECT_LT(c.falling, 0.02);
    EXPECT_GT(c.gap, 0);
    EXPECT_NEAR(c.gap_nodes, 300, 15);
  }
}

}  // namespace
}  // namespace scree
