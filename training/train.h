// train.h: fit one network to one body (SingleNetSDF), or one decoder and a code a body to many (CodedNetSDF).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "kernels/sdf/mlp.h"
#include "training/dataset.h"
#include "training/options.h"

namespace scree {

// After each epoch (one pass through the sample pool).
struct EpochRecord {
  int epoch = 0;
  int step = 0, steps = 0;       // done, and in all
  double loss = 0;               // mean over the epoch
  double train_mae = 0;          // of the training samples, mean over the epoch while the weights moved [d]
  double mean_mae = 0;           // of the bodies' test MAE [d]
  double worst_mae = 0;          // [d]
  std::vector<double> body_mae;  // test MAE by body [d]
  bool best = false;             // lowest mean MAE so far: this state is kept
  bool finish = false;           // the L-BFGS finish, recorded as one more epoch
  double seconds = 0;            // since the first step; what was done before a resumption counts
};

struct TrainedNet {
  Mlp net;
  std::vector<std::vector<float>> code;  // a row a body; empty rows without codes
  std::vector<double> mae;               // of the kept state, by body, on the test points [d]
  std::vector<EpochRecord> history;
  int best_epoch = 0;
  double seconds = 0;     // optimiser and tests
  std::string libraries;  // "LibTorch 1.13.1"
};

// A training that was stopped goes on as if it had not been: same bits.
struct Checkpointing {
  std::filesystem::path file;  // written after an epoch, under a temporary name first; empty: none
  double every_seconds = 60;   // not more often than this; 0: after each epoch
  bool resume = false;         // start from `file` if it is there
};

// The auto-decoder of Park et al. (2019), weights and codes together: the loss |phi - d| + slope_weight |u . (grad phi
// - grad d)| with a random direction u a sample (stochastic Sobolev training, Czarnecki et al. 2017), half a cosine as
// rate, or whatever else the options say. The state with the lowest mean test MAE is returned. One body without codes
// gives a SingleNetSDF. Same options and machine: same result, whatever the threads. Throws std::invalid_argument
// listing problems(options), without bodies, or where the checkpoint is of another training; std::runtime_error if the
// loss stops being finite or a checkpoint cannot be read or written.
TrainedNet train(std::vector<Body> const& bodies, TrainOptions const& options,
                 std::function<void(EpochRecord const&)> const& report = {}, Checkpointing const& checkpointing = {});

// Wall time of one step with these options [s], from a short trial after warming up: to choose steps for a time budget.
double seconds_per_step(std::vector<Body> const& bodies, TrainOptions const& options);

}  // namespace scree
