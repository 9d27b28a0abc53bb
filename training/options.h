// options.h: what a training is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/sdf/mlp.h"

namespace scree {

// Where training samples lie; the rest of the shares is uniform in the ball of 1.1 bounding radius.
struct SamplingOptions {
  int count = 60000;            // samples a shape
  double share_surface = 0.45;  // beside the surface, both sides: offset from N(0, band), of each five two with 4 bands
  double share_interior = 0.1;  // inwards from the surface by U(0, inscribed radius): phi must grow down to the centre
  double band = 0.012;          // [d]
};

struct TrainOptions {
  Activation activation = Activation::sine;
  double parameter = 8;        // omega of sine, slope of leaky_relu
  int layers = 5;              // hidden layers
  int width = 40;              // neurons a hidden layer
  int code_size = 0;           // latent numbers a shape; 0: one shape, no code
  int steps = 12000;           // optimiser steps; the rate follows half a cosine over them
  int rows = 1024;             // samples of a work unit; rows a shape = rows / shapes. 1,000 to 2,000 fit the cache
  int units = 2;               // work units a step: run by as many threads as there are, added in fixed order
  double rate = 1.5e-2;        // Adam's first rate, on weights times omega
  double code_rate = 5e-3;     // the same of the codes
  double code_spread = 0.3;    // standard deviation of the first codes
  double code_penalty = 1e-4;  // times the mean squared code (Park et al. 2019, DeepSDF, eq. 9)
  double slope_weight = 0.3;   // of the directional derivative in the loss; 0: distance only
  int test_count = 4000;       // test points a shape, uniform in the paper's shell
  std::uint64_t seed = 1;
  int threads = 2;
  SamplingOptions samples;
};

// Everything wrong, one sentence each; empty = valid.
std::vector<std::string> problems(TrainOptions const& options);

}  // namespace scree
