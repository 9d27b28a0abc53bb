// mlp_fold.h: how an activation's constant moves into the weights, so that hidden activations take none.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

#include "kernels/sdf/mlp.h"

namespace scree {

// Forward weights of layer 0, hidden layers and the last layer are multiplied by first, middle and last, biases of
// hidden layers by hidden_bias; backward_* turn what an activation records back into d phi / d z.
// Sine: sin(omega z) = sin(pi z'), z' = omega z / pi. Softplus: h = h' / beta, h' = log(1 + exp(beta z)).
struct Fold {
  double first = 1, middle = 1, last = 1, hidden_bias = 1, backward_first = 1, backward_middle = 1, backward_last = 1;
};

inline Fold fold_of(Mlp const& net) {
  double const a = net.parameter, pi = 3.14159265358979323846;
  switch (net.activation) {
    case Activation::leaky_relu:
      return {};
    case Activation::sine:
      return {a / pi, a / pi, 1, a / pi, a, a, 1};
    case Activation::softplus:
      return {a, 1, 1 / a, a, a, 1, 1 / a};
  }
  throw std::invalid_argument("unknown Activation");
}

}  // namespace scree
