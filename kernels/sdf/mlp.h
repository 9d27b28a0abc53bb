// mlp.h: a signed distance network and its readable double-precision evaluation.
// The reference every fast evaluator (SIMD, CUDA, tensor cores) is tested against; itself tested against LibTorch.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"

namespace scree {

enum class Activation {
  leaky_relu,  // z > 0 ? z : parameter * z
  sine,        // sin(parameter * z)
  softplus,    // log(1 + exp(parameter * z)) / parameter
};

char const* to_string(Activation activation);
Activation activation_from_string(std::string const& name);  // throws std::invalid_argument

// phi(x, code) = W_L h_L + b_L,  h_{l+1} = activation(W_l h_l + b_l),  h_0 = (x, y, z, code...).
// phi is positive inside. Inputs and phi are in the network's own unit (see Shape::query in shapes/shape.h).
struct Mlp {
  Activation activation = Activation::leaky_relu;
  double parameter = 0.01;                 // slope, omega or beta of the activation
  std::vector<int> width;                  // {3 + code size, hidden..., 1}
  std::vector<std::vector<float>> weight;  // [layer][in * width_out + out]
  std::vector<std::vector<float>> bias;    // [layer][out]

  int layers() const { return static_cast<int>(width.size()) - 1; }  // affine maps, the last one linear
  int code_size() const { return width.empty() ? 0 : width[0] - 3; }
};

// Everything wrong with a network (sizes, non-finite weights, unsupported shapes), one sentence each; empty = valid.
std::vector<std::string> problems(Mlp const& net);

// First-layer bias with the latent code folded in, b_0 + W_0[3:]^T code: exact, so that one decoder's weights serve
// every shape and a shape costs width[1] floats. Empty code: b_0. Sum in double, rounded once.
std::vector<float> fold_code(Mlp const& net, Span<const float> code);

// phi at `point` in double from the float weights; `first_bias` as from fold_code. `gradient` (may be null) receives
// d phi / d point, by forward tangents: slow and plain on purpose.
double evaluate_reference(Mlp const& net, Span<const float> first_bias, Vec3 point, Vec3* gradient = nullptr);

}  // namespace scree
