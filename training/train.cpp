// train.cpp: the training loop: epochs, rate, test, best state, checkpoints.
// SPDX-License-Identifier: Apache-2.0
#include "training/train.h"

#include <torch/version.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "training/checkpoint.h"
#include "training/trainer.h"

namespace scree {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void require_valid(std::vector<Body> const& bodies, TrainOptions const& options) {
  std::vector<std::string> wrong = problems(options);
  if (bodies.empty()) wrong.emplace_back("there is no body to learn");
  if (bodies.size() > 1 && options.code_size == 0) wrong.emplace_back("several bodies need a code size above 0");
  if (wrong.empty()) return;
  std::string text = "train: ";
  for (std::size_t i = 0; i < wrong.size(); ++i) text += (i > 0 ? "; " : "") + wrong[i];
  throw std::invalid_argument(text);
}

double rate_factor(TrainOptions const& options, int step) {
  if (options.schedule == Schedule::constant) return 1;
  return 0.5 + 0.5 * std::cos(std::numbers::pi * step / options.steps);
}

class Loop {
 public:
  Loop(std::vector<Body> const& bodies, TrainOptions const& options,
       std::function<void(EpochRecord const&)> const& report, Checkpointing const& checkpointing)
      : options_(options),
        report_(report),
        checkpointing_(checkpointing),
        trainer_(bodies, options),
        fingerprint_(fingerprint(bodies, options)) {
    progress_.best = INFINITY;
    if (checkpointing.resume && std::filesystem::exists(checkpointing.file)) {
      read_checkpoint(checkpointing.file, fingerprint_, trainer_, progress_);
      if (!progress_.history.empty()) before_ = progress_.history.back().seconds;
    }
    start_ = written_ = Clock::now();
  }

  TrainedNet run() {
    while (progress_.done < options_.steps) epoch();
    if (options_.finish.iterations > 0) finish();
    trainer_.decoder().load(progress_.best_weights, progress_.best_codes);
    TrainedNet result;
    result.libraries = "LibTorch " TORCH_VERSION;
    result.net = trainer_.decoder().to_mlp();
    result.code = trainer_.decoder().codes();
    result.mae = progress_.history.at(progress_.best_epoch - 1).body_mae;
    result.best_epoch = progress_.best_epoch;
    result.history = std::move(progress_.history);
    result.seconds = before_ + since(start_);
    return result;
  }

 private:
  void epoch() {
    trainer_.begin_epoch(++progress_.epoch);
    int const steps = std::min(trainer_.steps_per_epoch(), options_.steps - progress_.done);
    EpochRecord record;
    for (int k = 0; k < steps; ++k, ++progress_.done) {
      Trainer::StepLoss const loss = trainer_.step(k, rate_factor(options_, progress_.done));
      record.loss += loss.loss / steps;
      record.train_mae += loss.mae / steps;
    }
    close(record);
  }

  void finish() {
    ++progress_.epoch;
    EpochRecord record;
    record.loss = trainer_.finish().after;
    record.finish = true;
    close(record);
  }

  // Tests the state, keeps it if it is the best, writes it down.
  void close(EpochRecord& record) {
    if (!std::isfinite(record.loss))
      throw std::runtime_error("train: the loss is not finite in epoch " + std::to_string(progress_.epoch) +
                               "; lower the rate");
    record.epoch = progress_.epoch;
    record.step = progress_.done;
    record.steps = options_.steps;
    record.body_mae = trainer_.test();
    record.worst_mae = *std::max_element(record.body_mae.begin(), record.body_mae.end());
    record.mean_mae = std::accumulate(record.body_mae.begin(), record.body_mae.end(), 0.0) /
                      static_cast<double>(record.body_mae.size());
    record.best = record.mean_mae < progress_.best;
    record.seconds = before_ + since(start_);
    if (record.best) {
      progress_.best = record.mean_mae;
      progress_.best_epoch = record.epoch;
      progress_.best_weights = trainer_.decoder().flat_weights().clone();
      if (trainer_.decoder().flat_codes().defined()) progress_.best_codes = trainer_.decoder().flat_codes().clone();
    }
    progress_.history.push_back(record);
    bool const due = since(written_) >= checkpointing_.every_seconds;
    if (!checkpointing_.file.empty() && !record.finish && (due || progress_.done == options_.steps)) {
      write_checkpoint(checkpointing_.file, fingerprint_, trainer_, progress_);
      written_ = Clock::now();
    }
    if (report_) report_(record);
  }

  TrainOptions options_;
  std::function<void(EpochRecord const&)> report_;
  Checkpointing checkpointing_;
  Trainer trainer_;
  std::string fingerprint_;
  Progress progress_;
  double before_ = 0;  // seconds of the training that is resumed
  Clock::time_point start_, written_;
};

}  // namespace

TrainedNet train(std::vector<Body> const& bodies, TrainOptions const& options,
                 std::function<void(EpochRecord const&)> const& report, Checkpointing const& checkpointing) {
  require_valid(bodies, options);
  return Loop(bodies, options, report, checkpointing).run();
}

double seconds_per_step(std::vector<Body> const& bodies, TrainOptions const& options) {
  require_valid(bodies, options);
  TrainOptions trial = options;
  trial.samples.count = std::min(options.samples.count, 4 * options.rows);
  trial.test_count = 1;
  Trainer trainer(bodies, trial);
  int constexpr warm_up = 20, measured = 60;
  for (int k = 0; k < warm_up; ++k) trainer.step(k, 0);
  Clock::time_point const start = Clock::now();
  for (int k = 0; k < measured; ++k) trainer.step(k, 0);
  return since(start) / measured;
}

}  // namespace scree
