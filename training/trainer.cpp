// trainer.cpp: see trainer.h.
// SPDX-License-Identifier: Apache-2.0
#include "training/trainer.h"

#include <ATen/Parallel.h>
#include <dlfcn.h>
#include <torch/cuda.h>
#include <torch/optim/lbfgs.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace scree {
namespace {

using torch::Tensor;

// Each work unit runs on one thread: matrices of 1,000 rows are too small for a team, and sums then keep their order.
// LibTorch does not pass its thread count on to OpenBLAS.
void use_one_thread_inside() {
  at::set_num_threads(1);
  if (void* const symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads")) reinterpret_cast<void (*)(int)>(symbol)(1);
}

torch::Device device_of(std::string const& name) {
  bool const there = torch::cuda::is_available();
  if (name == "cuda" && !there)
    throw std::invalid_argument("device cuda: this LibTorch has no CUDA, or no device is there; use cpu or auto");
  return name == "cpu" || !there ? torch::kCPU : torch::kCUDA;
}

Tensor loss_of(Tensor const& error, Loss loss) {
  double constexpr kink = 1e-3;
  switch (loss) {
    case Loss::l1:
      return error.abs().mean();
    case Loss::l2:
      return error.square().mean();
    case Loss::smooth_l1:
      return (error.square() + kink * kink).sqrt().mean() - kink;
  }
  throw std::invalid_argument("Trainer: unknown loss");
}

}  // namespace

Trainer::Trainer(std::vector<Body> const& bodies, TrainOptions const& options)
    : options_(options),
      shapes_(static_cast<int>(bodies.size())),
      device_(device_of(options.device)),
      decoder_(options, shapes_, device_),
      random_(options.seed),
      weight_adam_(decoder_.flat_weights(), options.second_moment),
      code_adam_(options.code_size > 0 ? decoder_.flat_codes() : torch::zeros({0}), options.second_moment) {
  use_one_thread_inside();
  std::vector<Samples> pool, test;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    pool.push_back(training_samples(bodies[b], options.samples, options.seed + 1000 * b, options.threads));
    test.push_back(shell_samples(bodies[b], options.test_count, options.seed + 1000 * b + 500, options.threads));
  }
  blocks_ = make_blocks(pool, std::max(1, options.rows / shapes_), device_);
  test_ = make_blocks(test, std::max(1, 1024 / shapes_), device_);
  order_.resize(blocks_.size());
  begin_epoch(1);
}

int Trainer::steps_per_epoch() const { return std::max(1, static_cast<int>(blocks_.size()) / options_.units); }

void Trainer::begin_epoch(int epoch) {
  random_ = Random((options_.seed ^ 0x5ca1ab1eULL) + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(epoch));
  std::iota(order_.begin(), order_.end(), 0);
  for (int i = static_cast<int>(order_.size()) - 1; i > 0; --i) std::swap(order_[i], order_[random_.below(i + 1)]);
}

// Random unit vectors for the directional derivative; drawn by the host thread, so that threads do not change them.
Tensor Trainer::random_directions(Tensor const& like) {
  Tensor result = torch::empty(like.sizes(), torch::kFloat32);
  float* const data = result.data_ptr<float>();
  for (std::int64_t i = 0; i < result.numel(); i += 3) {
    Vec3 const u = random_.direction();
    for (int k = 0; k < 3; ++k) data[i + k] = static_cast<float>(u[k]);
  }
  return result.to(device_);
}

Trainer::StepLoss Trainer::step(int k, double rate_factor) {
  std::vector<SampleBlock const*> block(options_.units);
  std::vector<Tensor> direction(options_.units);
  for (int u = 0; u < options_.units; ++u) {
    block[u] = &blocks_[order_[(static_cast<std::size_t>(k) * options_.units + u) % order_.size()]];
    if (options_.slope_weight > 0) direction[u] = random_directions(block[u]->point);
  }
  UnitResult const mean = mean_of(block, direction, options_.loss);
  torch::NoGradGuard const no_gradient;
  std::int64_t const weights = decoder_.flat_weights().numel();
  weight_adam_.step(mean.gradient.narrow(0, 0, weights), options_.rate * rate_factor);
  if (options_.code_size > 0) {
    Tensor const gradient = mean.gradient.narrow(0, weights, mean.gradient.numel() - weights);
    double const rate = options_.code_rate * rate_factor;
    if (options_.code_rule == CodeRule::adam) {
      code_adam_.step(gradient, rate);
    } else {
      Tensor codes = decoder_.flat_codes();
      codes.sub_(gradient, rate).clamp_(-options_.code_limit, options_.code_limit);
    }
  }
  return mean.loss;
}

std::vector<double> Trainer::test() const {
  std::vector<Tensor> sum(test_.size());
#pragma omp parallel for schedule(static) num_threads(device_.is_cpu() ? options_.threads : 1)
  for (std::size_t b = 0; b < test_.size(); ++b) {
    torch::NoGradGuard const guard;  // thread-local
    sum[b] = (decoder_.forward(test_[b].point, {}).phi - test_[b].phi).abs().mean(1).to(torch::kFloat64);
  }
  Tensor mean = torch::zeros({shapes_}, torch::kFloat64);
  for (Tensor const& s : sum) mean += s.to(torch::kCPU) / static_cast<double>(sum.size());
  return {mean.data_ptr<double>(), mean.data_ptr<double>() + shapes_};
}

// | |grad phi| - 1 |, the gradient by three tangents.
Tensor Trainer::eikonal_loss(SampleBlock const& block, Loss loss) const {
  Tensor square;
  for (int axis = 0; axis < 3; ++axis) {
    Tensor direction = torch::zeros_like(block.point);
    direction.select(2, axis).fill_(1);
    Tensor const slope = decoder_.forward(block.point, direction).slope.square();
    square = square.defined() ? square + slope : slope;
  }
  return loss_of((square + 1e-12).sqrt() - 1, loss);
}

Trainer::UnitResult Trainer::unit(SampleBlock const& block, Tensor const& direction, Loss kind) const {
  Decoder::Output const out = decoder_.forward(block.point, direction);
  Tensor const error = out.phi - block.phi;
  Tensor loss = loss_of(error, kind);
  if (direction.defined())
    loss = loss + options_.slope_weight * loss_of(out.slope - (block.gradient * direction).sum(2), kind);
  if (options_.eikonal_weight > 0) loss = loss + options_.eikonal_weight * eikonal_loss(block, kind);
  if (options_.code_size > 0 && options_.code_penalty > 0)
    loss = loss + options_.code_penalty * decoder_.code_matrix().square().mean();
  std::vector<Tensor> parts;
  for (Tensor const& g : decoder_.gradients(loss)) parts.push_back(g.reshape({-1}));
  return {torch::cat(parts), {loss.item<double>(), error.detach().abs().mean().item<double>()}};
}

Trainer::UnitResult Trainer::mean_of(std::vector<SampleBlock const*> const& block, std::vector<Tensor> const& direction,
                                     Loss loss) const {
  int const n = static_cast<int>(block.size());
  int const threads = device_.is_cpu() ? std::min(n, options_.threads) : 1;
  std::vector<UnitResult> result(n);
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int k = 0; k < n; ++k) result[k] = unit(*block[k], direction[k], loss);
  torch::NoGradGuard const no_gradient;
  for (int k = 1; k < n; ++k) {
    result[0].gradient.add_(result[k].gradient);
    result[0].loss.loss += result[k].loss.loss;
    result[0].loss.mae += result[k].loss.mae;
  }
  result[0].gradient.div_(static_cast<double>(n));
  result[0].loss.loss /= n;
  result[0].loss.mae /= n;
  return result[0];
}

Trainer::FinishLoss Trainer::finish() {
  int const rows = static_cast<int>(blocks_.front().point.size(1));
  int const count = std::clamp(options_.finish.samples / rows, 1, static_cast<int>(blocks_.size()));
  std::vector<SampleBlock const*> block;
  std::vector<Tensor> direction(count);
  for (int k = 0; k < count; ++k) {
    block.push_back(&blocks_[k]);
    if (options_.slope_weight > 0) direction[k] = random_directions(blocks_[k].point);
  }
  std::vector<Tensor> parameter = {decoder_.flat_weights()};
  if (options_.code_size > 0) parameter.push_back(decoder_.flat_codes());
  auto const options = torch::optim::LBFGSOptions(1.0)
                           .max_iter(options_.finish.iterations)
                           .max_eval(options_.finish.iterations * 5 / 4)
                           .history_size(options_.finish.history)
                           .tolerance_grad(1e-9)
                           .tolerance_change(1e-12)
                           .line_search_fn("strong_wolfe");
  torch::optim::LBFGS optimiser(parameter, options);
  FinishLoss loss;
  bool first = true;
  optimiser.step([&] {
    UnitResult const mean = mean_of(block, direction, Loss::smooth_l1);
    std::int64_t const weights = parameter[0].numel();
    parameter[0].mutable_grad() = mean.gradient.narrow(0, 0, weights);
    if (parameter.size() > 1)
      parameter[1].mutable_grad() = mean.gradient.narrow(0, weights, mean.gradient.numel() - weights);
    if (first) loss.before = mean.loss.loss;
    first = false;
    return torch::tensor(mean.loss.loss);
  });
  loss.after = mean_of(block, direction, Loss::smooth_l1).loss.loss;
  return loss;
}

}  // namespace scree
