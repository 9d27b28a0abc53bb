// net_derivatives.cpp: see net_derivatives.h.
// SPDX-License-Identifier: Apache-2.0
#include "training/net_derivatives.h"

#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

// z becomes the activation's value, `slope` its derivative.
void activate(Activation activation, double parameter, Eigen::MatrixXd& z, Eigen::MatrixXd& slope) {
  slope.resize(z.rows(), z.cols());
  switch (activation) {
    case Activation::leaky_relu:
      slope = (z.array() > 0).select(Eigen::MatrixXd::Ones(z.rows(), z.cols()), parameter);
      z.array() *= slope.array();
      return;
    case Activation::sine:
      slope = parameter * (parameter * z.array()).cos();
      z = (parameter * z.array()).sin();
      return;
    case Activation::softplus:
      slope = 1 / (1 + (-parameter * z.array()).exp());
      // log(1 + e^y) = max(y, 0) + log(1 + e^-|y|): no overflow
      z = z.array().max(0) + ((-parameter * z.array().abs()).exp() + 1).log() / parameter;
      return;
  }
  throw std::invalid_argument("this Activation does not exist");
}

}  // namespace

NetDerivatives::NetDerivatives(Mlp const& net)
    : activation_(net.activation), parameter_(net.parameter), code_size_(net.code_size()) {
  for (int l = 0; l < net.layers(); ++l) {
    // Stored input by input, which is column-major for (out, in).
    weight_.push_back(
        Eigen::Map<Eigen::MatrixXf const>(net.weight[l].data(), net.width[l + 1], net.width[l]).cast<double>());
    bias_.push_back(Eigen::Map<Eigen::VectorXf const>(net.bias[l].data(), net.width[l + 1]).cast<double>());
  }
}

void NetDerivatives::evaluate(Eigen::MatrixXd const& point, Eigen::VectorXd const& code, Output& out) const {
  std::size_t const hidden = weight_.size() - 1;
  std::vector<Eigen::MatrixXd> slope(hidden);
  // The code is the same at every point: it joins the bias.
  Eigen::MatrixXd h = weight_[0].leftCols(3) * point;
  h.colwise() += bias_[0] + weight_[0].rightCols(code_size_) * code;
  for (std::size_t l = 0; l < hidden; ++l) {
    activate(activation_, parameter_, h, slope[l]);
    Eigen::MatrixXd next = weight_[l + 1] * h;
    next.colwise() += bias_[l + 1];
    h = std::move(next);
  }
  out.phi = h.row(0);
  Eigen::MatrixXd delta = Eigen::MatrixXd::Ones(1, point.cols());  // d phi / d (the affine map of a layer)
  for (std::size_t l = hidden; l-- > 0;)
    delta = ((weight_[l + 1].transpose() * delta).array() * slope[l].array()).matrix().eval();
  out.by_point = weight_[0].leftCols(3).transpose() * delta;
  out.by_code = weight_[0].rightCols(code_size_).transpose() * delta;
}

}  // namespace scree
