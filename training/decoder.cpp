// decoder.cpp: the network being trained, as LibTorch tensors, and its export.
// SPDX-License-Identifier: Apache-2.0
#include "training/decoder.h"

#include <torch/csrc/autograd/custom_function.h>

#include <cmath>
#include <stdexcept>

#include "shapes/random.h"

namespace scree {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::tensor_list;

// act(z) with its first and, where asked for, second derivative. For sine z = omega (W h + b) and the derivatives are
// by z: see Decoder.
struct Activated {
  Tensor value, first, second;
};
Activated activate(Tensor const& z, Activation activation, double parameter, bool with_second) {
  switch (activation) {
    case Activation::sine: {
      Tensor const value = z.sin();
      return {value, z.cos(), with_second ? value.neg() : Tensor()};
    }
    case Activation::softplus: {
      Tensor const scaled = z * parameter, first = scaled.sigmoid();
      // log(1 + exp t) = max(t, 0) + log1p(exp(-|t|))
      Tensor const value = (scaled.abs().neg().exp().log1p() + scaled.clamp_min(0)).div_(parameter);
      return {value, first, with_second ? (first * (1 - first)).mul_(parameter) : Tensor()};
    }
    case Activation::leaky_relu: {
      Tensor const first = (z > 0).to(z.dtype()).mul_(1 - parameter).add_(parameter);
      return {z * first, first, Tensor()};  // the second derivative is 0 wherever there is one
    }
  }
  throw std::invalid_argument("Decoder: unknown activation");
}

// value = act(z) and slope = act'(z) u, the derivative carried along one direction, as one differentiable step:
// autograd over the single operations would compute sine and cosine twice each.
struct Activate : torch::autograd::Function<Activate> {
  static tensor_list forward(AutogradContext* context, Tensor const& z, Tensor const& u, std::int64_t activation,
                             double parameter) {
    Activated const a = activate(z, static_cast<Activation>(activation), parameter, true);
    context->save_for_backward({a.first, a.second.defined() ? a.second * u : Tensor()});
    return {a.value, u * a.first};
  }

  static tensor_list backward(AutogradContext* context, tensor_list gradient) {
    auto const saved = context->get_saved_variables();
    Tensor const &first = saved[0], &second_u = saved[1];
    Tensor dz = gradient[0] * first;
    if (second_u.defined()) dz.addcmul_(gradient[1], second_u);
    return {dz, gradient[1] * first, Tensor(), Tensor()};
  }
};

// The same without the slope.
struct ActivateValue : torch::autograd::Function<ActivateValue> {
  static Tensor forward(AutogradContext* context, Tensor const& z, std::int64_t activation, double parameter) {
    Activated const a = activate(z, static_cast<Activation>(activation), parameter, false);
    context->save_for_backward({a.first});
    return a.value;
  }
  static tensor_list backward(AutogradContext* context, tensor_list gradient) {
    return {gradient[0] * context->get_saved_variables()[0], Tensor(), Tensor()};
  }
};

Tensor uniform_tensor(std::int64_t count, double bound, Random& random) {
  Tensor result = torch::empty({count}, torch::kFloat32);
  float* const data = result.data_ptr<float>();
  for (std::int64_t i = 0; i < count; ++i) data[i] = static_cast<float>(random.uniform(-bound, bound));
  return result;
}

std::vector<float> to_vector(Tensor const& tensor) {
  Tensor const flat = tensor.detach().to(torch::kCPU).contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

}  // namespace

Decoder::Decoder(TrainOptions const& options, int shapes, torch::Device const& device)
    : activation_(options.activation), parameter_(options.parameter), shapes_(shapes), code_size_(options.code_size) {
  width_.push_back(3 + code_size_);
  width_.insert(width_.end(), options.layers, options.width);
  width_.push_back(1);
  Random random(options.seed);
  std::vector<Tensor> parts;
  bool const sine = activation_ == Activation::sine;
  for (std::size_t l = 0; l + 1 < width_.size(); ++l) {
    int const in = width_[l], out = width_[l + 1];
    bool const last = l + 2 == width_.size();
    // He et al. (2015) for leaky ReLU and softplus; for sine the bound of Sitzmann et al. (2020), which in weights
    // times omega is sqrt(6 / in) whatever omega. The first layer sees coordinates below 1, not unit variance: omega
    // / 2.
    double bound = std::sqrt(6.0 / in);
    if (sine && l == 0) bound = parameter_ / 2;
    if (last) bound = std::sqrt(1.0 / in);
    parts.push_back(uniform_tensor(static_cast<std::int64_t>(in) * out, bound, random));
    parts.push_back(uniform_tensor(out, last ? 0 : 1 / std::sqrt(in), random));
  }
  weights_ = torch::cat(parts).to(device);
  std::int64_t offset = 0;
  for (std::size_t l = 0; l + 1 < width_.size(); ++l) {
    std::int64_t const in = width_[l], out = width_[l + 1];
    leaf_.push_back(weights_.narrow(0, offset, in * out).view({in, out}).detach().requires_grad_());
    leaf_.push_back(weights_.narrow(0, offset + in * out, out).detach().requires_grad_());
    offset += in * out + out;
  }
  if (code_size_ == 0) return;
  codes_ = torch::empty({shapes_ * code_size_}, torch::kFloat32);
  float* const code = codes_.data_ptr<float>();
  bool const normal = options.code_start == CodeStart::normal;
  for (std::int64_t i = 0; i < codes_.numel(); ++i)
    code[i] = static_cast<float>(options.code_spread * (normal ? random.normal() : random.uniform(-1, 1)));
  codes_ = codes_.to(device);
  leaf_.push_back(codes_.view({shapes_, code_size_}).detach().requires_grad_());
}

Tensor Decoder::code_matrix() const { return code_size_ > 0 ? leaf_.back() : Tensor(); }

Decoder::Output Decoder::forward(Tensor const& point, Tensor const& direction) const {
  std::int64_t const activation = static_cast<std::int64_t>(activation_);
  bool const with_slope = direction.defined();
  std::int64_t const shapes = point.size(0), rows = point.size(1);
  Tensor const w = leaf_[0].narrow(0, 0, 3);
  // A shape's code only shifts the first layer's bias: one row a shape instead of one a sample.
  Tensor bias = leaf_[1].unsqueeze(0);
  if (code_size_ > 0) bias = bias + code_matrix().mm(leaf_[0].narrow(0, 3, code_size_));
  Tensor z = (point.reshape({-1, 3}).mm(w).view({shapes, rows, -1}) + bias.unsqueeze(1)).view({shapes * rows, -1});
  Tensor u = with_slope ? direction.reshape({-1, 3}).mm(w) : Tensor();
  std::size_t const affine = width_.size() - 1;
  for (std::size_t l = 1; l < affine; ++l) {
    Tensor value;
    if (with_slope) {
      tensor_list const both = Activate::apply(z, u, activation, parameter_);
      value = both[0];
      u = both[1].mm(leaf_[2 * l]);
    } else {
      value = ActivateValue::apply(z, activation, parameter_);
    }
    z = torch::addmm(leaf_[2 * l + 1], value, leaf_[2 * l]);
  }
  return {z.view({shapes, rows}), with_slope ? u.view({shapes, rows}) : Tensor()};
}

std::vector<Tensor> Decoder::gradients(Tensor const& loss) const { return torch::autograd::grad({loss}, leaf_); }

void Decoder::load(Tensor const& weights, Tensor const& codes) {
  torch::NoGradGuard const no_gradient;
  weights_.copy_(weights);
  if (code_size_ > 0) codes_.copy_(codes);
}

Mlp Decoder::to_mlp() const {
  Mlp net;
  net.activation = activation_;
  net.parameter = parameter_;
  net.width = width_;
  for (std::size_t l = 0; l + 1 < width_.size(); ++l) {
    bool const scaled = activation_ == Activation::sine && l + 2 < width_.size();
    double const omega = scaled ? parameter_ : 1;
    net.weight.push_back(to_vector(leaf_[2 * l] / omega));
    net.bias.push_back(to_vector(leaf_[2 * l + 1] / omega));
  }
  return net;
}

std::vector<std::vector<float>> Decoder::codes() const {
  std::vector<std::vector<float>> result(shapes_);
  for (int s = 0; s < shapes_ && code_size_ > 0; ++s) result[s] = to_vector(code_matrix()[s]);
  return result;
}

}  // namespace scree
