// options.h: what a training is asked for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/sdf/mlp.h"

namespace scree {

// ball: within 1.1 bounding radii, where a network is ever evaluated. paper_shell: between 0.9 inscribed and 1.1
// bounding radii (Li et al. 2026, section 3.1).
enum class SampleRegion { ball, paper_shell };

// Where training samples lie; the rest of the shares is uniform in the region.
struct SamplingOptions {
  int count = 60000;  // samples a shape
  SampleRegion region = SampleRegion::ball;
  double share_surface = 0.35;  // beside the surface, both sides: offset from N(0, band), of each five two with 4 bands
  double share_curved = 0.15;   // beside edges and bends: mesh edges by turning angle x length, offset as above but in
                                // all directions
  double share_interior = 0.1;  // inwards from the surface by U(0, inscribed radius): phi must grow down to the centre
  double band = 0.012;          // [d]
};

enum class Loss {
  l1,         // |phi - d|
  l2,         // (phi - d)^2, and the slope's likewise
  smooth_l1,  // sqrt((phi - d)^2 + w^2) - w, w = 1e-3: l1 without its kink
};

enum class Schedule {
  constant,
  cosine,  // half a cosine from the first rate to zero
};

// How codes follow the loss.
enum class CodeRule {
  adam,      // like the weights, with a rate of their own and a penalty (Park et al. 2019)
  gradient,  // z <- z - code_rate dL/dz, clamped to code_limit (Li et al. 2026, eq. 1)
};

enum class CodeStart {
  normal,   // N(0, code_spread)
  uniform,  // U(-code_spread, code_spread)
};

// Quasi-Newton iterations on a fixed set of samples after the last step: Adam's noise is gone, so smooth bodies gain.
struct FinishOptions {
  int iterations = 0;   // of L-BFGS with a strong Wolfe search; 0: none
  int history = 40;     // pairs of vectors it remembers
  int samples = 20000;  // of each shape, the first of its pool
};

struct TrainOptions {
  Activation activation = Activation::sine;
  double parameter = 8;  // omega of sine, slope of leaky_relu, beta of softplus
  int layers = 5;        // hidden layers
  int width = 40;        // neurons a hidden layer
  int code_size = 0;     // latent numbers a shape; 0: one shape, no code
  int steps = 12000;     // optimiser steps
  int rows = 1024;       // samples of a work unit; rows a shape = rows / shapes. 1,000 to 2,000 fit the cache
  int units = 2;         // work units a step: run by as many threads as there are, added in fixed order
  Loss loss = Loss::l1;
  Schedule schedule = Schedule::cosine;
  double rate = 1.5e-2;         // Adam's first rate, on weights times omega where the activation is sine
  double second_moment = 0.99;  // Adam's beta_2
  CodeRule code_rule = CodeRule::adam;
  CodeStart code_start = CodeStart::normal;
  double code_rate = 5e-3;     // first rate of the codes
  double code_spread = 0.3;    // of the first codes
  double code_penalty = 1e-4;  // times the mean squared code (Park et al. 2019, DeepSDF, eq. 9)
  double code_limit = 10;      // largest |number| of a code under CodeRule::gradient
  double slope_weight = 0.3;   // of the directional derivative in the loss; 0: distance only
  double eikonal_weight = 0;   // of | |grad phi| - 1 | in the loss; triples the cost of a step
  FinishOptions finish;
  int test_count = 4000;  // test points a shape, uniform in the paper's shell
  std::uint64_t seed = 1;
  int threads = 2;
  std::string device = "cpu";  // "cpu", "cuda", or "auto": CUDA where LibTorch has it and a device is there
  SamplingOptions samples;
};

// Everything wrong, one sentence each; empty = valid.
std::vector<std::string> problems(TrainOptions const& options);

// What scree-train uses: sine, normals in the loss, samples where contacts are. Measured in training/README.md.
TrainOptions default_single_options();
TrainOptions default_coded_options();

// The recipe of Li et al. (2026), sections 2.6 and 3: LeakyReLU, 10,000 uniform samples in the shell, Adam at a
// constant 1e-3, batches of 128, 100 epochs; codes from U(-1, 1) by plain gradient steps of 1e-3. Its loss is not
// stated; the mean absolute error, which it reports and selects by, is taken. 5 x 40 and 6 x 40.
TrainOptions paper_single_options();
TrainOptions paper_coded_options(int shapes);

// Steps that make `epochs` passes through the pool.
int steps_of_epochs(TrainOptions const& options, int shapes, int epochs);

}  // namespace scree
