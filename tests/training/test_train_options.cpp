// test_train_options.cpp: what the options of a training do: samples, losses, codes, finish, resumption.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <torch/cuda.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "shapes/analytic_shapes.h"
#include "tests/training/training_bodies.h"
#include "training/surface_sampler.h"
#include "training/train.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

TEST(Recipes, AreValidAndThePapersHasItsSizes) {
  EXPECT_TRUE(problems(default_single_options()).empty());
  EXPECT_TRUE(problems(default_coded_options()).empty());
  TrainOptions const single = paper_single_options(), coded = paper_coded_options(20);
  EXPECT_TRUE(problems(single).empty());
  EXPECT_TRUE(problems(coded).empty());
  EXPECT_EQ(single.steps, 100 * (10000 / 128));        // 100 epochs of whole batches
  EXPECT_EQ(coded.steps, 100 * (10000 / (128 / 20)));  // 6 samples of each of the 20 bodies a step
  EXPECT_EQ(single.samples.region, SampleRegion::paper_shell);
}

TEST(Recipes, ThePapersSamplesLieInItsShellAlone) {
  Body const body = ellipsoid_body("e", {1.4, 1.1, 1});
  Samples const samples = training_samples(body, paper_single_options().samples, 1, 2);
  ASSERT_EQ(samples.point.size(), 10000u);
  for (Vec3 x : samples.point) {
    EXPECT_GE(norm(x), 0.9 * body.inscribed_radius * (1 - 1e-12));
    EXPECT_LE(norm(x), 1.1 * body.bounding_radius * (1 + 1e-12));
  }
}

TEST(SurfaceSampler, CurvedPointsOfABoxLieOnItsEdgesByLength) {
  // 1 x 2 x 4: all edges turn by a right angle, so a direction's share is its length's. Diagonals of faces turn by 0.
  TriangleMesh box;
  for (int k = 0; k < 8; ++k) box.vertex.push_back({k & 1 ? 1.0 : 0, k & 2 ? 2.0 : 0, k & 4 ? 4.0 : 0});
  box.triangle = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  SurfaceSampler const sampler(box, true);
  Random random(1);
  int constexpr n = 7000;
  int along[3] = {};
  for (int i = 0; i < n; ++i) {
    Vec3 const x = sampler.draw_curved(random);
    int inner = 0, axis = -1;
    for (int k = 0; k < 3; ++k)
      if (x[k] > 1e-9 && x[k] < (1 << k) - 1e-9) ++inner, axis = k;
    ASSERT_EQ(inner, 1) << "not on an edge: " << x.x << ' ' << x.y << ' ' << x.z;
    ++along[axis];
  }
  for (int k = 0; k < 3; ++k) {
    double const share = (1 << k) / 7.0;
    EXPECT_NEAR(along[k], n * share, 5 * std::sqrt(n * share * (1 - share)));
  }
}

TEST(AnalyticBody, HasTheFormulasDistancesMassAndSurface) {
  Shape const shape = builtin_shape("superellipsoid:1:0.8:0.6:0.5");
  Body const body = make_body("s", shape);
  EXPECT_EQ(body.inertia.x, shape.inertia.x);
  Samples const surface = surface_samples(body, 2000, 3);
  Vec3 sum;
  for (std::size_t i = 0; i < surface.point.size(); ++i) {
    Vec3 gradient;
    EXPECT_NEAR(signed_distance(shape.analytic, surface.point[i], &gradient), 0, 1e-9);
    sum += surface.point[i] / 2000;
  }
  EXPECT_LT(norm(sum), 5 * 0.4 / std::sqrt(2000.0));  // even over the surface: its centroid is the origin
  Samples const shell = shell_samples(body, 500, 1, 2);
  for (std::size_t i = 0; i < shell.point.size(); ++i)
    EXPECT_EQ(shell.phi[i], signed_distance(shape.analytic, shell.point[i], nullptr));
  Shape net;
  net.kind = ShapeKind::net;
  EXPECT_THROW(make_body("n", net), std::invalid_argument);
}

// Spread of |grad phi| about 1 at points of the shell, by the exported network.
double slope_spread(TrainedNet const& trained, Body const& body) {
  Samples const test = shell_samples(body, 1000, 7, 2);
  double sum = 0;
  for (Vec3 x : test.point) {
    Vec3 gradient;
    evaluate_reference(trained.net, fold_code(trained.net, {}), x, &gradient);
    sum += std::abs(norm(gradient) - 1) / 1000;
  }
  return sum;
}

TEST(Losses, SlopeAndEikonalTermsStraightenTheGradient) {
  Body const body = ellipsoid_body("e", {1.4, 1.1, 1});
  TrainOptions options = tiny_options();
  options.slope_weight = 0;
  double const plain = slope_spread(train({body}, options), body);
  options.eikonal_weight = 0.3;
  double const eikonal = slope_spread(train({body}, options), body);
  options.eikonal_weight = 0;
  options.slope_weight = 0.3;
  double const slope = slope_spread(train({body}, options), body);
  EXPECT_LT(eikonal, 0.6 * plain);
  EXPECT_LT(slope, 0.6 * plain);
  options.loss = Loss::l2;
  EXPECT_LT(train({body}, options).mae[0], 0.02);
}

TEST(Codes, ThePapersRuleKeepsThemInItsLimit) {
  std::vector<Body> const bodies = {ellipsoid_body("flat", {1.5, 1.5, 1}, 2), ellipsoid_body("long", {1.8, 1, 1}, 2)};
  TrainOptions options = tiny_options();
  options.code_size = 3;
  options.steps = 30;
  options.code_rule = CodeRule::gradient;
  options.code_start = CodeStart::uniform;
  options.code_spread = 1;
  options.code_limit = 1.5;
  options.code_rate = 1e4;  // thrown against the limit
  double largest = 0;
  for (auto const& code : train(bodies, options).code)
    for (float z : code) largest = std::max(largest, std::abs(double(z)));
  EXPECT_DOUBLE_EQ(largest, 1.5);
}

TEST(Finish, QuasiNewtonImprovesASmoothBody) {
  Body const body = make_body("e", builtin_shape("ellipsoid:1:0.8:0.7"));
  TrainOptions options = tiny_options();
  options.steps = 300;
  options.finish.iterations = 150;
  options.finish.samples = 1000;
  TrainedNet const trained = train({body}, options);
  EpochRecord const &last = trained.history.back(), &before = trained.history[trained.history.size() - 2];
  ASSERT_TRUE(last.finish);
  EXPECT_FALSE(before.finish);
  EXPECT_LT(last.mean_mae, 0.8 * before.mean_mae);
  EXPECT_EQ(trained.best_epoch, last.epoch);
  EXPECT_EQ(train({body}, options).net.weight, trained.net.weight);
}

class Resume : public testing::Test {
 protected:
  Resume() : folder_(fs::temp_directory_path() / ("scree_resume_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~Resume() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST_F(Resume, StoppedAnywhereGivesTheBitsOfNeverStopped) {
  std::vector<Body> const bodies = {ellipsoid_body("flat", {1.5, 1.5, 1}, 2), ellipsoid_body("long", {1.8, 1, 1}, 2)};
  TrainOptions options = tiny_options();
  options.code_size = 2;
  options.steps = 120;
  TrainedNet const whole = train(bodies, options);
  int const epochs = static_cast<int>(whole.history.size());
  ASSERT_GE(epochs, 4);
  for (int stop : {1, 2, epochs - 1}) {
    Checkpointing const keep{folder_ / "state.pt", 0, true};
    fs::remove(keep.file);
    struct Stop {};
    auto const interrupt = [&](EpochRecord const& r) {
      if (r.epoch == stop) throw Stop();
    };
    EXPECT_THROW(train(bodies, options, interrupt, keep), Stop);
    TrainedNet const resumed = train(bodies, options, {}, keep);
    EXPECT_EQ(resumed.net.weight, whole.net.weight);
    EXPECT_EQ(resumed.code, whole.code);
    EXPECT_EQ(resumed.mae, whole.mae);
    EXPECT_EQ(resumed.best_epoch, whole.best_epoch);
    ASSERT_EQ(resumed.history.size(), whole.history.size());
    for (int e = 0; e < epochs; ++e) EXPECT_EQ(resumed.history[e].body_mae, whole.history[e].body_mae);
  }
}

TEST_F(Resume, RefusesAnotherTrainingAndDamage) {
  std::vector<Body> const bodies = {ellipsoid_body("e", {1.4, 1.1, 1}, 2)};
  TrainOptions options = tiny_options();
  options.steps = 30;
  Checkpointing const keep{folder_ / "state.pt", 0, true};
  train(bodies, options, {}, keep);
  options.rate *= 1.5;
  EXPECT_THROW(train(bodies, options, {}, keep), std::invalid_argument);
  std::ofstream(keep.file, std::ios::trunc) << "no archive";
  EXPECT_THROW(train(bodies, options, {}, keep), std::runtime_error);
  EXPECT_THROW(train(bodies, options, {}, {folder_ / "nowhere" / "state.pt", 0, false}), std::runtime_error);
}

TEST(Device, CudaIsRefusedWhereThereIsNone) {
  if (torch::cuda::is_available()) GTEST_SKIP() << "there is a CUDA device here";
  Body const body = ellipsoid_body("e", {1.4, 1.1, 1}, 2);
  TrainOptions options = tiny_options();
  options.steps = 2;
  options.device = "cuda";
  EXPECT_THROW(train({body}, options), std::invalid_argument);
  options.device = "auto";
  TrainedNet const by_itself = train({body}, options);
  options.device = "cpu";
  EXPECT_EQ(by_itself.net.weight, train({body}, options).net.weight);
}

}  // namespace
}  // namespace scree
