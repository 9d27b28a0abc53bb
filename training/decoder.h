// decoder.h: the network being trained, as LibTorch tensors, and its export. Internal to training: the only header with
// LibTorch in it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <torch/csrc/autograd/autograd.h>
#include <torch/types.h>

#include <vector>

#include "kernels/sdf/mlp.h"
#include "training/options.h"

namespace scree {

// Weights and codes live in one flat tensor each, so that an optimiser step is a handful of calls; `leaf` are views of
// it that autograd differentiates. Weights are stored times omega for sine, z = omega (W h + b), which saves a pass
// over the activations; export divides it out.
class Decoder {
 public:
  Decoder(TrainOptions const& options, int shapes, torch::Device const& device = torch::kCPU);

  // phi (shapes, rows) and, unless `direction` is undefined, its derivative along `direction`.
  //   point, direction (shapes, rows, 3). Thread-safe as long as nobody writes the parameters.
  struct Output {
    torch::Tensor phi, slope;
  };
  Output forward(torch::Tensor const& point, torch::Tensor const& direction) const;

  // Gradients of `loss` with respect to leaves(), in their order.
  std::vector<torch::Tensor> gradients(torch::Tensor const& loss) const;

  std::vector<torch::Tensor> const& leaves() const {
    return leaf_;
  }  // w0, b0, w1, b1, ..., codes last if there are any
  torch::Tensor const& flat_weights() const { return weights_; }
  torch::Tensor const& flat_codes() const { return codes_; }  // (shapes * code_size); undefined without codes
  torch::Tensor code_matrix() const;                          // leaf (shapes, code_size); undefined without codes

  // Copies into the parameters; codes are ignored where there are none.
  void load(torch::Tensor const& weights, torch::Tensor const& codes);

  Mlp to_mlp() const;
  std::vector<std::vector<float>> codes() const;

 private:
  Activation activation_;
  double parameter_;
  int shapes_, code_size_;
  std::vector<int> width_;
  torch::Tensor weights_, codes_;
  std::vector<torch::Tensor> leaf_;
};

}  // namespace scree
