// net_derivatives.h: phi of a network in double with its derivatives by point and code, many points at a time.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/sdf/mlp.h"

namespace scree {

class NetDerivatives {
 public:
  explicit NetDerivatives(Mlp const& net);

  // All in the network's frame and unit. One pass forwards, one back (reverse mode): about three times the cost of phi.
  //   point (3, n), code (code size); out: phi (n), by_point (3, n), by_code (code size, n), resized as needed
  // Thread-safe.
  struct Output {
    Eigen::RowVectorXd phi;
    Eigen::MatrixXd by_point, by_code;
  };
  void evaluate(Eigen::MatrixXd const& point, Eigen::VectorXd const& code, Output& out) const;

  int code_size() const { return code_size_; }

 private:
  Activation activation_;
  double parameter_;
  int code_size_;
  std::vector<Eigen::MatrixXd> weight_;  // (out, in) of each layer
  std::vector<Eigen::VectorXd> bias_;
};

}  // namespace scree
