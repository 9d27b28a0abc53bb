// mlp.cpp: see mlp.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/mlp.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scree {

char const* to_string(Activation activation) {
  switch (activation) {
    case Activation::leaky_relu:
      return "leaky_relu";
    case Activation::sine:
      return "sine";
    case Activation::softplus:
      return "softplus";
  }
  throw std::invalid_argument("unknown Activation");
}

Activation activation_from_string(std::string const& name) {
  for (Activation a : {Activation::leaky_relu, Activation::sine, Activation::softplus})
    if (name == to_string(a)) return a;
  throw std::invalid_argument("unknown activation '" + name + "' (leaky_relu, sine, softplus)");
}

std::vector<std::string> problems(Mlp const& net) {
  std::vector<std::string> found;
  int const layers = net.layers();
  if (layers < 2) return {"a network needs at least one hidden layer"};
  if (net.width.front() < 3) found.push_back("the input width must be 3 or more");
  if (net.width.back() != 1) found.push_back("the output width must be 1");
  for (int w : net.width)
    if (w < 1 || w > 1024) found.push_back("layer width " + std::to_string(w) + " is outside 1..1024");
  if (!(std::isfinite(net.parameter)) || net.parameter < 0)
    found.push_back("the activation parameter must be finite and not negative");
  if (static_cast<int>(net.weight.size()) != layers || static_cast<int>(net.bias.size()) != layers) {
    found.push_back("weights and biases do not match the number of layers");
    return found;
  }
  for (int l = 0; l < layers; ++l) {
    auto const& w = net.weight[l];
    auto const& b = net.bias[l];
    if (w.size() != std::size_t(net.width[l]) * net.width[l + 1] || b.size() != std::size_t(net.width[l + 1])) {
      found.push_back("layer " + std::to_string(l) + " has weights or biases of the wrong size");
      continue;
    }
    auto const bad = [](float v) { return !std::isfinite(v); };
    if (std::any_of(w.begin(), w.end(), bad) || std::any_of(b.begin(), b.end(), bad))
      found.push_back("layer " + std::to_string(l) + " has a NaN or infinite weight");
  }
  return found;
}

std::vector<float> fold_code(Mlp const& net, Span<const float> code) {
  if (code.size() != net.code_size())
    throw std::invalid_argument("fold_code: the code has " + std::to_string(code.size()) +
                                " numbers, the network takes " + std::to_string(net.code_size()));
  std::vector<float> folded = net.bias[0];
  int const out = net.width[1];
  for (int j = 0; j < out; ++j) {
    double sum = net.bias[0][j];
    for (int k = 0; k < code.size(); ++k) sum += double(net.weight[0][std::size_t(3 + k) * out + j]) * code[k];
    folded[j] = static_cast<float>(sum);
  }
  return folded;
}

namespace {

double activate(Activation activation, double parameter, double z, double& slope) {
  switch (activation) {
    case Activation::leaky_relu:
      slope = z > 0 ? 1 : parameter;
      return slope * z;
    case Activation::sine:
      slope = parameter * std::cos(parameter * z);
      return std::sin(parameter * z);
    case Activation::softplus: {
      double const t = parameter * z;
      slope = 1 / (1 + std::exp(-t));
      return (std::max(t, 0.0) + std::log1p(std::exp(-std::abs(t)))) / parameter;
    }
  }
  throw std::invalid_argument("unknown Activation");
}

}  // namespace

double evaluate_reference(Mlp const& net, Span<const float> first_bias, Vec3 point, Vec3* gradient) {
  std::vector<double> h = {point.x, point.y, point.z};
  std::vector<Vec3> dh = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // d h / d point
  for (int l = 0; l < net.layers(); ++l) {
    int const out = net.width[l + 1];
    std::vector<double> next(out);
    std::vector<Vec3> dnext(out);
    for (int j = 0; j < out; ++j) {
      double z = l == 0 ? first_bias[j] : net.bias[l][j];
      Vec3 dz;
      for (std::size_t k = 0; k < h.size(); ++k) {  // layer 0: the code's rows are in first_bias
        double const w = net.weight[l][k * out + j];
        z += w * h[k];
        dz += dh[k] * w;
      }
      double slope = 1;
      next[j] = l + 1 < net.layers() ? activate(net.activation, net.parameter, z, slope) : z;
      dnext[j] = dz * slope;
    }
    h = std::move(next);
    dh = std::move(dnext);
  }
  if (gradient) *gradient = dh[0];
  return h[0];
}

}  // namespace scree
