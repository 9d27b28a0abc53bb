// checkpoint.h: the state of a training in a file. Internal to training.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <torch/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "training/train.h"
#include "training/trainer.h"

namespace scree {

// What the loop of train() carries from epoch to epoch beside the trainer.
struct Progress {
  int epoch = 0, done = 0;  // epochs and steps behind us
  double best = 0;          // lowest mean test MAE [d]
  int best_epoch = 0;
  torch::Tensor best_weights, best_codes;
  std::vector<EpochRecord> history;
};

// Everything that a result depends on, as text: options, bodies, LibTorch. Equal text: the same training.
std::string fingerprint(std::vector<Body> const& bodies, TrainOptions const& options);

// Atomic: a temporary name, then renamed. Throws std::runtime_error naming the file.
void write_checkpoint(std::filesystem::path const& file, std::string const& fingerprint, Trainer& trainer,
                      Progress const& progress);

// Throws std::runtime_error naming the file if it cannot be read; std::invalid_argument if it is of another training.
void read_checkpoint(std::filesystem::path const& file, std::string const& fingerprint, Trainer& trainer,
                     Progress& progress);

}  // namespace scree
