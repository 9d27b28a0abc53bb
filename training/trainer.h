// trainer.h: one network in training: batches, losses, optimiser steps, test errors. Internal to training: train() in
// train.h is the loop over it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "shapes/random.h"
#include "training/adam.h"
#include "training/dataset.h"
#include "training/decoder.h"
#include "training/options.h"
#include "training/pool.h"

namespace scree {

class Trainer {
 public:
  // Draws all samples. Valid options and bodies are the caller's business. Throws std::invalid_argument for a device
  // that is not there.
  Trainer(std::vector<Body> const& bodies, TrainOptions const& options);

  int steps_per_epoch() const;
  void begin_epoch(int epoch);  // shuffles; whatever came before, the same epoch has the same order and directions

  struct StepLoss {
    double loss = 0;  // what is minimised, mean over the batch
    double mae = 0;   // mean |phi - d| [d]
  };
  // Step `k` of this epoch, with all rates times `rate_factor`.
  StepLoss step(int k, double rate_factor);

  // L-BFGS on the first samples of each body's pool, with Loss::smooth_l1: the kink of the mean absolute error stops
  // line searches. Returns that loss before and after.
  struct FinishLoss {
    double before = 0, after = 0;
  };
  FinishLoss finish();

  std::vector<double> test() const;  // mean absolute error on the test points, by body [d]

  Decoder& decoder() { return decoder_; }
  Adam& weight_adam() { return weight_adam_; }
  Adam& code_adam() { return code_adam_; }

 private:
  struct UnitResult {
    torch::Tensor gradient;  // flat, weights then codes
    StepLoss loss;
  };
  UnitResult unit(SampleBlock const& block, torch::Tensor const& direction, Loss loss) const;
  torch::Tensor eikonal_loss(SampleBlock const& block, Loss loss) const;
  // Mean gradient and loss over blocks, by as many threads as there are, added in fixed order.
  UnitResult mean_of(std::vector<SampleBlock const*> const& block, std::vector<torch::Tensor> const& direction,
                     Loss loss) const;
  torch::Tensor random_directions(torch::Tensor const& like);

  TrainOptions options_;
  int shapes_;
  torch::Device device_;
  Decoder decoder_;
  Random random_;
  Adam weight_adam_, code_adam_;
  std::vector<SampleBlock> blocks_, test_;
  std::vector<int> order_;
};

}  // namespace scree
