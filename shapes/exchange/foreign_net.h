// foreign_net.h: a network that another program trained, from its named weights.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sdf/mlp.h"
#include "shapes/exchange/safetensors.h"

namespace scree {

struct ForeignNet {
  Activation activation = Activation::leaky_relu;
  double parameter = 0.01;       // slope, omega or beta
  bool negative_inside = false;  // the other sign convention: the last layer is negated
};

// The state of a torch.nn.Sequential and its like: every tensor is "<layer>.weight" [out, in] with its "<layer>.bias"
// [out], layers in the order of their names, numbers in them as numbers ("10" after "2"). Inputs x, y, z and then a
// code. A tensor "codes" [shapes, code size] may stand beside them. Throws std::runtime_error naming the tensor.
Mlp net_of(TensorFile const& content, ForeignNet const& convention);

// Rows of "codes"; one empty row without it. Throws std::runtime_error where it does not fit the network.
std::vector<std::vector<float>> codes_of(TensorFile const& content, Mlp const& net);

}  // namespace scree
