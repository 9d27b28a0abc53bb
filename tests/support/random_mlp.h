// random_mlp.h: random networks for tests, scaled so that |phi| and its gradient are of order one.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "kernels/sdf/mlp.h"

namespace scree::test {

// He et al. (2015) weights for leaky_relu and softplus, Sitzmann et al. (2020, SIREN) weights for sine. Biases are
// random too, so that a bias in the wrong place shows.
inline Mlp random_mlp(Activation activation, double parameter, std::vector<int> width, std::uint64_t seed) {
  Mlp net;
  net.activation = activation;
  net.parameter = parameter;
  net.width = std::move(width);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  bool const sine = activation == Activation::sine;
  for (int l = 0; l < net.layers(); ++l) {
    int const in = net.width[l], out = net.width[l + 1];
    bool const last = l + 1 == net.layers();
    double scale = std::sqrt(6.0 / in);  // uniform with the variance 2 / in
    if (sine) scale = l == 0 ? 1.0 / in : std::sqrt(6.0 / in) / parameter;
    if (last) scale = std::sqrt(3.0 / in);  // phi has the variance of the last activations
    auto& w = net.weight.emplace_back();
    auto& b = net.bias.emplace_back();
    for (int i = 0; i < in * out; ++i) w.push_back(static_cast<float>(scale * uniform(random)));
    for (int i = 0; i < out; ++i) b.push_back(static_cast<float>(0.1 * uniform(random)));
  }
  return net;
}

inline std::vector<Vec3f> random_points(int n, double half_size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(static_cast<float>(-half_size), static_cast<float>(half_size));
  std::vector<Vec3f> points(n);
  for (auto& p : points) p = {uniform(random), uniform(random), uniform(random)};
  return points;
}

inline std::vector<float> random_code(int n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
  std::vector<float> code(n);
  for (auto& c : code) c = uniform(random);
  return code;
}

}  // namespace scree::test
