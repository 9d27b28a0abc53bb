// truth.cpp: see truth.h.
// SPDX-License-Identifier: Apache-2.0
#include "training/truth.h"

#include <algorithm>
#include <stdexcept>

#include "shapes/mesh/mesh_distance.h"

namespace scree {
namespace {

class MeshTruth : public Truth {
 public:
  explicit MeshTruth(TriangleMesh const& mesh) : distance_(mesh) {}
  void evaluate(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient, int threads) const override {
    distance_.evaluate(point, phi, gradient, threads);
  }

 private:
  MeshDistance distance_;
};

class AnalyticTruth : public Truth {
 public:
  explicit AnalyticTruth(AnalyticSdf const& shape) : shape_(shape) {}
  void evaluate(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient, int threads) const override {
    int const n = point.size();
    if (phi.size() != n || (!gradient.empty() && gradient.size() != n))
      throw std::invalid_argument("AnalyticTruth::evaluate: points, phi and gradient differ in count");
#pragma omp parallel for schedule(dynamic, 256) num_threads(std::max(threads, 1))
    for (int i = 0; i < n; ++i) phi[i] = signed_distance(shape_, point[i], gradient.empty() ? nullptr : &gradient[i]);
  }

 private:
  AnalyticSdf shape_;
};

}  // namespace

std::shared_ptr<Truth const> mesh_truth(TriangleMesh const& mesh) { return std::make_shared<MeshTruth const>(mesh); }

std::shared_ptr<Truth const> analytic_truth(AnalyticSdf const& shape) {
  return std::make_shared<AnalyticTruth const>(shape);
}

}  // namespace scree
