// harmonics_fit.cpp: see harmonics_fit.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/harmonics_fit.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/sdf/harmonics.h"

namespace scree {

HarmonicsFit fit_harmonics(std::vector<Vec3> const& surface_point, int degree) {
  if (degree < 0 || degree > 20)
    throw std::invalid_argument("harmonics: degree " + std::to_string(degree) + " is not in 0 ... 20");
  int const n = static_cast<int>(surface_point.size()), terms = harmonic_count(degree);
  if (n < terms)
    throw std::invalid_argument("harmonics: degree " + std::to_string(degree) + " needs at least " +
                                std::to_string(terms) + " points, there are " + std::to_string(n));
  Eigen::MatrixXd basis(n, terms);
  Eigen::VectorXd radius(n);
  std::vector<double> row(terms);
  for (int i = 0; i < n; ++i) {
    radius[i] = norm(surface_point[i]);
    if (!(radius[i] > 0) || !std::isfinite(radius[i]))
      throw std::invalid_argument("harmonics: point " + std::to_string(i) + " has no direction from the centre");
    harmonics(degree, surface_point[i] / radius[i], row);
    for (int k = 0; k < terms; ++k) basis(i, k) = row[k];
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> const qr(basis);
  if (qr.rank() < terms)
    throw std::invalid_argument("harmonics: the points leave " + std::to_string(terms - qr.rank()) + " of " +
                                std::to_string(terms) + " coefficients open; spread them evenly or lower the degree");
  Eigen::VectorXd const c = qr.solve(radius), residual = radius - basis * c;
  HarmonicsFit fit;
  fit.coefficient.assign(c.data(), c.data() + terms);
  fit.rms = std::sqrt(residual.squaredNorm() / n);
  fit.largest = residual.cwiseAbs().maxCoeff();
  return fit;
}

}  // namespace scree
