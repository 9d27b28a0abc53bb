// latent.cpp: see latent.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/latent.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

double constexpr negligible = 1e-12;  // of the largest variance: rounding of directions that the codes do not span

bool is_coded(Shape const& shape) { return shape.is_net() && !shape.code.empty(); }

// Normal, cut off. Narrow cuts from the uniform density, of which exp(-1/2) or more is kept.
double truncated_normal(double truncate, Random& random) {
  while (true) {
    double const x = truncate < 1 ? random.uniform(-truncate, truncate) : random.normal();
    if (truncate < 1 ? random.uniform() < std::exp(-0.5 * x * x) : std::abs(x) <= truncate) return x;
  }
}

std::vector<Shape const*> members(Library const& library, std::string const& category) {
  std::vector<Shape const*> found;
  for (Shape const& shape : library.shape)
    if (is_coded(shape) && category_of(shape.name) == category) found.push_back(&shape);
  if (found.empty()) {
    std::string known;
    for (std::string const& c : coded_categories(library)) known += (known.empty() ? "" : ", ") + c;
    throw std::invalid_argument("no category '" + category + "' with latent codes; " +
                                (known.empty() ? "no shape here has a code" : "there are " + known));
  }
  if (found.size() < 2)
    throw std::invalid_argument("category '" + category + "' has one code; a Gaussian needs two or more");
  for (Shape const* shape : found)
    if (shape->net != found[0]->net)
      throw std::invalid_argument("category '" + category + "': '" + shape->name + "' and '" + found[0]->name +
                                  "' belong to different networks, their codes cannot be compared");
  return found;
}

}  // namespace

std::string category_of(std::string const& shape_name) {
  std::size_t const slash = shape_name.rfind('/');
  return slash == std::string::npos ? "" : shape_name.substr(0, slash);
}

std::vector<std::string> coded_categories(Library const& library) {
  std::vector<std::string> found;
  for (Shape const& shape : library.shape) {
    std::string const category = category_of(shape.name);
    if (is_coded(shape) && std::find(found.begin(), found.end(), category) == found.end()) found.push_back(category);
  }
  return found;
}

CodeGaussian fit_codes(Library const& library, std::string const& category, double shrinkage) {
  if (!(shrinkage >= 0 && shrinkage < 1)) throw std::invalid_argument("fit_codes: shrinkage must be in [0, 1)");
  std::vector<Shape const*> const member = members(library, category);
  auto const n = static_cast<Eigen::Index>(member.size()), size = static_cast<Eigen::Index>(member[0]->code.size());
  Eigen::MatrixXd deviation(n, size);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < size; ++k) deviation(i, k) = member[i]->code[k];
  Eigen::RowVectorXd const mean = deviation.colwise().mean();
  deviation.rowwise() -= mean;
  Eigen::MatrixXd covariance = deviation.transpose() * deviation / static_cast<double>(n - 1);
  double const mean_variance = covariance.trace() / static_cast<double>(size);
  covariance = (1 - shrinkage) * covariance + shrinkage * mean_variance * Eigen::MatrixXd::Identity(size, size);
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const solver(covariance);

  CodeGaussian gaussian{category, member[0]->net, static_cast<int>(n), {mean.begin(), mean.end()}, {}};
  double const largest = solver.eigenvalues()(size - 1);
  for (Eigen::Index k = size - 1; k >= 0 && solver.eigenvalues()(k) > negligible * largest; --k) {
    Eigen::VectorXd axis = solver.eigenvectors().col(k);
    // The sign is the solver's whim; fixed, so that a seed draws the same codes everywhere.
    Eigen::Index at = 0;
    axis.cwiseAbs().maxCoeff(&at);
    axis *= std::copysign(std::sqrt(solver.eigenvalues()(k)), axis(at));
    gaussian.axis.emplace_back(axis.begin(), axis.end());
  }
  return gaussian;
}

std::vector<float> draw_code(CodeGaussian const& gaussian, double truncate, Random& random) {
  if (!(truncate > 0)) throw std::invalid_argument("draw_code: truncate must be positive");
  std::vector<double> code = gaussian.mean;
  for (std::vector<double> const& axis : gaussian.axis) {
    double const xi = truncated_normal(truncate, random);
    for (std::size_t k = 0; k < code.size(); ++k) code[k] += xi * axis[k];
  }
  return {code.begin(), code.end()};
}

std::vector<double> whitened(CodeGaussian const& gaussian, std::vector<float> const& code) {
  std::vector<double> xi;
  for (std::vector<double> const& axis : gaussian.axis) {
    double along = 0, variance = 0;
    for (std::size_t k = 0; k < axis.size(); ++k) {
      along += axis[k] * (code[k] - gaussian.mean[k]);
      variance += axis[k] * axis[k];
    }
    xi.push_back(along / variance);
  }
  return xi;
}

std::vector<float> interpolate_codes(Shape const& a, Shape const& b, double t) {
  for (Shape const* shape : {&a, &b})
    if (!is_coded(*shape)) throw std::invalid_argument("shape '" + shape->name + "' has no latent code");
  if (a.net != b.net)
    throw std::invalid_argument("shapes '" + a.name + "' and '" + b.name +
                                "' belong to different networks: there is no line between their codes");
  std::vector<float> code;
  for (std::size_t k = 0; k < a.code.size(); ++k)
    code.push_back(static_cast<float>((1 - t) * a.code[k] + t * b.code[k]));
  return code;
}

}  // namespace scree
