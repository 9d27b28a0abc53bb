// train.cpp: the training loop: batches, optimiser, test, best state.
// SPDX-License-Identifier: Apache-2.0
#include "training/train.h"

#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <torch/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "shapes/random.h"
#include "training/decoder.h"
#include "training/pool.h"

namespace scree {
namespace {

using torch::Tensor;
using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// Each work unit runs on one thread: matrices of 1,000 rows are too small for a team, and sums then keep their order.
// LibTorch does not pass its thread count on to OpenBLAS.
void use_one_thread_inside() {
  at::set_num_threads(1);
  if (void* const symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<void (*)(int)>(symbol)(1);
}

// Kingma and Ba (2015) on a flat tensor.
class Adam {
 public:
  explicit Adam(Tensor const& parameter)
      : parameter_(parameter), mean_(torch::zeros_like(parameter)), square_(torch::zeros_like(parameter)) {}
  void step(Tensor const& gradient, double rate) {
    double constexpr beta1 = 0.9, beta2 = 0.99, tiny = 1e-10;
    ++count_;
    mean_.mul_(beta1).add_(gradient, 1 - beta1);
    square_.mul_(beta2).addcmul_(gradient, gradient, 1 - beta2);
    double const scale = rate / (1 - std::pow(beta1, count_)) * std::sqrt(1 - std::pow(beta2, count_));
    parameter_.addcdiv_(mean_, square_.sqrt().add_(tiny), -scale);
  }

 private:
  Tensor parameter_, mean_, square_;
  int count_ = 0;
};

// Random unit vectors for the directional derivative; drawn by the host thread, so that threads do not change them.
Tensor random_directions(Tensor const& like, Random& random) {
  Tensor result = torch::empty_like(like);
  float* const data = result.data_ptr<float>();
  for (std::int64_t i = 0; i < result.numel(); i += 3) {
    Vec3 const u = random.direction();
    for (int k = 0; k < 3; ++k) data[i + k] = static_cast<float>(u[k]);
  }
  return result;
}

class Trainer {
 public:
  Trainer(std::vector<Body> const& bodies, TrainOptions const& options)
      : options_(options),
        shapes_(static_cast<int>(bodies.size())),
        decoder_(options, shapes_),
        random_(options.seed ^ 0x5ca1ab1eULL),
        weight_adam_(decoder_.flat_weights()),
        code_adam_(options.code_size > 0 ? decoder_.flat_codes() : torch::zeros({0})) {
    use_one_thread_inside();
    std::vector<Samples> pool, test;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      pool.push_back(training_samples(bodies[b], options.samples, options.seed + 1000 * b, options.threads));
      test.push_back(shell_samples(bodies[b], options.test_count, options.seed + 1000 * b + 500, options.threads));
    }
    blocks_ = make_blocks(pool, std::max(1, options.rows / shapes_));
    test_ = make_blocks(test, std::max(1, 1024 / shapes_));
    order_.resize(blocks_.size());
    std::iota(order_.begin(), order_.end(), 0);
  }

  int steps_per_epoch() const { return std::max(1, static_cast<int>(blocks_.size()) / options_.units); }
  Decoder const& decoder() const { return decoder_; }

  void shuffle() {
    for (int i = static_cast<int>(order_.size()) - 1; i > 0; --i) std::swap(order_[i], order_[random_.below(i + 1)]);
  }

  // One optimiser step on the `units` blocks from `first` of the shuffled order. Returns the mean loss.
  double step(int first, double rate_factor) {
    int const units = options_.units;
    std::vector<SampleBlock const*> block(units);
    std::vector<Tensor> direction(units);
    for (int k = 0; k < units; ++k) {
      block[k] = &blocks_[order_[(first + k) % order_.size()]];
      if (options_.slope_weight > 0) direction[k] = random_directions(block[k]->point, random_);
    }
    std::vector<std::vector<Tensor>> gradient(units);
    std::vector<double> loss(units);
#pragma omp parallel for schedule(static, 1) num_threads(std::min(units, options_.threads))
    for (int k = 0; k < units; ++k) loss[k] = unit(*block[k], direction[k], gradient[k]);
    apply(gradient, rate_factor);
    return std::accumulate(loss.begin(), loss.end(), 0.0) / units;
  }

  // Mean absolute error on the test points, by body.
  std::vector<double> test() const {
    torch::NoGradGuard const no_gradient;
    std::vector<Tensor> sum(test_.size());
#pragma omp parallel for schedule(static) num_threads(options_.threads)
    for (std::size_t b = 0; b < test_.size(); ++b) {
      torch::NoGradGuard const guard;  // thread-local
      sum[b] = (decoder_.forward(test_[b].point, {}).phi - test_[b].phi).abs().mean(1).to(torch::kFloat64);
    }
    Tensor mean = torch::zeros({shapes_}, torch::kFloat64);
    for (Tensor const& s : sum) mean += s / static_cast<double>(sum.size());
    return {mean.data_ptr<double>(), mean.data_ptr<double>() + shapes_};
  }

 private:
  double unit(SampleBlock const& block, Tensor const& direction, std::vector<Tensor>& gradient) const {
    Decoder::Output const out = decoder_.forward(block.point, direction);
    Tensor loss = (out.phi - block.phi).abs().mean();
    if (direction.defined()) {
      Tensor const target = (block.gradient * direction).sum(2);
      loss = loss + options_.slope_weight * (out.slope - target).abs().mean();
    }
    if (options_.code_size > 0) loss = loss + options_.code_penalty * decoder_.code_matrix().square().mean();
    gradient = decoder_.gradients(loss);
    return loss.item<double>();
  }

  void apply(std::vector<std::vector<Tensor>> const& gradient, double rate_factor) {
    torch::NoGradGuard const no_gradient;
    std::vector<Tensor> flat;
    for (auto const& unit_gradient : gradient) {
      std::vector<Tensor> parts;
      for (Tensor const& g : unit_gradient) parts.push_back(g.reshape({-1}));
      flat.push_back(torch::cat(parts));
    }
    for (std::size_t k = 1; k < flat.size(); ++k) flat[0].add_(flat[k]);
    flat[0].div_(static_cast<double>(flat.size()));
    std::int64_t const weights = decoder_.flat_weights().numel();
    weight_adam_.step(flat[0].narrow(0, 0, weights), options_.rate * rate_factor);
    if (options_.code_size > 0)
      code_adam_.step(flat[0].narrow(0, weights, flat[0].numel() - weights), options_.code_rate * rate_factor);
  }

  TrainOptions options_;
  int shapes_;
  Decoder decoder_;
  Random random_;
  Adam weight_adam_, code_adam_;
  std::vector<SampleBlock> blocks_, test_;
  std::vector<int> order_;
};

void require_valid(std::vector<Body> const& bodies, TrainOptions const& options) {
  std::vector<std::string> wrong = problems(options);
  if (bodies.empty()) wrong.emplace_back("there is no body to learn");
  if (bodies.size() > 1 && options.code_size == 0) wrong.emplace_back("several bodies need a code size above 0");
  if (wrong.empty()) return;
  std::string text = "train: ";
  for (std::size_t i = 0; i < wrong.size(); ++i) text += (i > 0 ? "; " : "") + wrong[i];
  throw std::invalid_argument(text);
}

}  // namespace

TrainedNet train(std::vector<Body> const& bodies, TrainOptions const& options,
                 std::function<void(EpochRecord const&)> const& report) {
  require_valid(bodies, options);
  Trainer trainer(bodies, options);
  TrainedNet result;
  result.libraries = "LibTorch " TORCH_VERSION;
  Clock::time_point const start = Clock::now();
  int const per_epoch = trainer.steps_per_epoch();
  double best = INFINITY;
  for (int done = 0, epoch = 1; done < options.steps; ++epoch) {
    trainer.shuffle();
    int const now = std::min(per_epoch, options.steps - done);
    double loss = 0;
    for (int k = 0; k < now; ++k, ++done)
      loss += trainer.step(k * options.units, 0.5 + 0.5 * std::cos(std::numbers::pi * done / options.steps)) / now;
    if (!std::isfinite(loss))
      throw std::runtime_error("train: the loss is not finite in epoch " + std::to_string(epoch) + "; lower the rate");
    std::vector<double> const mae = trainer.test();
    EpochRecord record{epoch, done,        options.steps, loss, 0, *std::max_element(mae.begin(), mae.end()),
                       false, since(start)};
    record.mean_mae = std::accumulate(mae.begin(), mae.end(), 0.0) / static_cast<double>(mae.size());
    record.best = record.mean_mae < best;
    if (record.best) {
      best = record.mean_mae;
      result.net = trainer.decoder().to_mlp();
      result.code = trainer.decoder().codes();
      result.mae = mae;
      result.best_epoch = epoch;
    }
    result.history.push_back(record);
    if (report) report(record);
  }
  result.seconds = since(start);
  return result;
}

double seconds_per_step(std::vector<Body> const& bodies, TrainOptions const& options) {
  require_valid(bodies, options);
  TrainOptions trial = options;
  trial.samples.count = std::min(options.samples.count, 4 * options.rows);
  trial.test_count = 1;
  Trainer trainer(bodies, trial);
  int constexpr warm_up = 20, measured = 60;
  for (int k = 0; k < warm_up; ++k) trainer.step(k * options.units, 0);
  Clock::time_point const start = Clock::now();
  for (int k = 0; k < measured; ++k) trainer.step(k * options.units, 0);
  return since(start) / measured;
}

}  // namespace scree
