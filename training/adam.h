// adam.h: Kingma and Ba (2015) on a flat tensor. Internal to training.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <torch/types.h>

#include <cmath>

namespace scree {

class Adam {
 public:
  Adam(torch::Tensor const& parameter, double second_moment)
      : parameter_(parameter),
        mean_(torch::zeros_like(parameter)),
        square_(torch::zeros_like(parameter)),
        beta2_(second_moment) {}

  void step(torch::Tensor const& gradient, double rate) {
    double constexpr beta1 = 0.9, tiny = 1e-10;
    ++count_;
    mean_.mul_(beta1).add_(gradient, 1 - beta1);
    square_.mul_(beta2_).addcmul_(gradient, gradient, 1 - beta2_);
    double const scale =
        rate / (1 - std::pow(beta1, static_cast<double>(count_))) * std::sqrt(1 - std::pow(beta2_, count_));
    parameter_.addcdiv_(mean_, square_.sqrt().add_(tiny), -scale);
  }

  // What a resumed training needs.
  torch::Tensor const& mean() const { return mean_; }
  torch::Tensor const& square() const { return square_; }
  std::int64_t count() const { return count_; }
  void restore(torch::Tensor const& mean, torch::Tensor const& square, std::int64_t count) {
    mean_.copy_(mean);
    square_.copy_(square);
    count_ = count;
  }

 private:
  torch::Tensor parameter_, mean_, square_;
  double beta2_;
  std::int64_t count_ = 0;
};

}  // namespace scree
