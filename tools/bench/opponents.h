// opponents.h: what bench_sdf compares with: the same network by other means.
// The network is leaky_relu. Every opponent runs on one thread and in float.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"
#include "kernels/sdf/mlp.h"
#include "tools/bench/peak_meter.h"

namespace scree::bench {

class Opponent {
 public:
  virtual ~Opponent() = default;
  // Evaluate all points, `chunk` at a time.
  virtual void forward(Span<const Vec3f> point, int chunk, Span<float> phi) = 0;
  virtual void gradient(Span<const Vec3f> point, int chunk, Span<float> phi, Span<Vec3f> gradient) = 0;
};

std::unique_ptr<Opponent> make_eigen(Mlp const& net);        // as fast as we could write it
std::unique_ptr<Opponent> make_plain_eigen(Mlp const& net);  // as Eigen's manual would write it
std::unique_ptr<Opponent> make_torch(Mlp const& net);        // only where LibTorch was found

// Trilinear interpolation in a level-set grid of 43^3 nodes over [-half, half]^3, the network sampled at the nodes.
// `chunk` is ignored. 43^3 floats are 318 kB: in L2 or L3, as one grain's grid would be.
std::unique_ptr<Opponent> make_grid(Mlp const& net, double half);

// The BLAS that LibTorch calls, as loaded: library file name and its own description.
std::string blas_in_use();
// One thread for the BLAS and LibTorch.
void use_one_thread();

}  // namespace scree::bench
