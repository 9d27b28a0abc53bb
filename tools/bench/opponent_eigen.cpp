// opponent_eigen.cpp: the network layer by layer with Eigen, features x points, compiled for AVX2 + FMA like ours.
// SPDX-License-Identifier: Apache-2.0
#define EIGEN_DONT_PARALLELIZE
#include <Eigen/Core>
#include <algorithm>

#include "tools/bench/opponents.h"

namespace scree::bench {

namespace {

using Matrix = Eigen::MatrixXf;
using Points = Eigen::Map<const Eigen::Matrix<float, 3, Eigen::Dynamic>>;
using Row = Eigen::Map<Eigen::RowVectorXf>;

// Buffers kept, products without temporaries.
class EigenNet final : public Opponent {
 public:
  explicit EigenNet(Mlp const& net) : slope_(static_cast<float>(net.parameter)) {
    for (int l = 0; l < net.layers(); ++l) {  // weight [in][out] row by row is [out x in] column by column
      weight_.push_back(Eigen::Map<Matrix const>(net.weight[l].data(), net.width[l + 1], net.width[l]));
      bias_.push_back(Eigen::Map<Eigen::VectorXf const>(net.bias[l].data(), net.width[l + 1]));
    }
    value_.resize(weight_.size());
  }

  void forward(Span<const Vec3f> point, int chunk, Span<float> phi) override {
    for (int first = 0; first < point.size(); first += chunk) chunk_forward(point, first, chunk, phi);
  }

  void gradient(Span<const Vec3f> point, int chunk, Span<float> phi, Span<Vec3f> gradient) override {
    for (int first = 0; first < point.size(); first += chunk) {
      int const n = chunk_forward(point, first, chunk, phi);
      std::size_t const last = weight_.size() - 1;
      cotangent_.noalias() = weight_[last].transpose() * Eigen::RowVectorXf::Ones(n);
      for (std::size_t l = last; l-- > 0;) {
        cotangent_.array() *= (value_[l].array() > 0).select(Eigen::ArrayXXf::Ones(value_[l].rows(), n), slope_);
        below_.noalias() = weight_[l].transpose() * cotangent_;
        cotangent_.swap(below_);
      }
      Eigen::Map<Eigen::Matrix<float, 3, Eigen::Dynamic>>(&gradient[first].x, 3, n) = cotangent_;
    }
  }

 private:
  int chunk_forward(Span<const Vec3f> point, int first, int chunk, Span<float> phi) {
    int const n = std::min(chunk, point.size() - first);
    std::size_t const last = weight_.size() - 1;
    for (std::size_t l = 0; l < last; ++l) {
      if (l == 0)
        value_[0].noalias() = weight_[0] * Points(&point[first].x, 3, n);
      else
        value_[l].noalias() = weight_[l] * value_[l - 1];
      value_[l].colwise() += bias_[l];
      value_[l] = value_[l].cwiseMax(slope_ * value_[l]);
    }
    Row out(phi.data + first, n);
    out.noalias() = weight_[last] * value_[last - 1];
    out.array() += bias_[last](0);
    return n;
  }

  float slope_;
  std::vector<Matrix> weight_, value_;
  std::vector<Eigen::VectorXf> bias_;
  Matrix cotangent_, below_;
};

// One expression a layer, a new matrix for each.
class PlainEigenNet final : public Opponent {
 public:
  explicit PlainEigenNet(Mlp const& net) : slope_(static_cast<float>(net.parameter)) {
    for (int l = 0; l < net.layers(); ++l) {
      weight_.push_back(Eigen::Map<Matrix const>(net.weight[l].data(), net.width[l + 1], net.width[l]));
      bias_.push_back(Eigen::Map<Eigen::VectorXf const>(net.bias[l].data(), net.width[l + 1]));
    }
  }

  void forward(Span<const Vec3f> point, int chunk, Span<float> phi) override {
    for (int first = 0; first < point.size(); first += chunk) {
      int const n = std::min(chunk, point.size() - first);
      std::vector<Matrix> h = evaluate(Points(&point[first].x, 3, n));
      Row(phi.data + first, n) = h.back();
    }
  }

  void gradient(Span<const Vec3f> point, int chunk, Span<float> phi, Span<Vec3f> gradient) override {
    for (int first = 0; first < point.size(); first += chunk) {
      int const n = std::min(chunk, point.size() - first);
      std::vector<Matrix> h = evaluate(Points(&point[first].x, 3, n));
      Row(phi.data + first, n) = h.back();
      Matrix g = Matrix::Ones(1, n);
      for (std::size_t l = weight_.size(); l-- > 0;) {
        g = weight_[l].transpose() * g;
        if (l > 0) g = (h[l - 1].array() > 0).select(g, slope_ * g);
      }
      Eigen::Map<Eigen::Matrix<float, 3, Eigen::Dynamic>>(&gradient[first].x, 3, n) = g;
    }
  }

 private:
  std::vector<Matrix> evaluate(Matrix const& x) const {
    std::vector<Matrix> h;
    for (std::size_t l = 0; l < weight_.size(); ++l) {
      Matrix z = (weight_[l] * (l == 0 ? x : h.back())).colwise() + bias_[l];
      h.push_back(l + 1 < weight_.size() ? Matrix(z.cwiseMax(slope_ * z)) : z);
    }
    return h;
  }

  float slope_;
  std::vector<Matrix> weight_;
  std::vector<Eigen::VectorXf> bias_;
};

}  // namespace

std::unique_ptr<Opponent> make_plain_eigen(Mlp const& net) { return std::make_unique<PlainEigenNet>(net); }

std::unique_ptr<Opponent> make_eigen(Mlp const& net) { return std::make_unique<EigenNet>(net); }

}  // namespace scree::bench
