// harmonics_mesh.cpp: see harmonics_mesh.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/harmonics_mesh.h"

#include <stdexcept>

#include "kernels/sdf/harmonics.h"
#include "shapes/mesh/mesh_measures.h"
#include "shapes/support_points.h"

namespace scree {

TriangleMesh harmonics_mesh(std::vector<double> const& coefficient, int vertices) {
  if (harmonic_degree(static_cast<int>(coefficient.size())) < 0)
    throw std::invalid_argument("harmonics: the number of coefficients must be a square");
  TriangleMesh mesh = convex_hull(quasi_uniform_directions(vertices));
  for (Vec3& v : mesh.vertex) {
    double const r = harmonic_radius(coefficient, v, nullptr);
    if (!(r > 0)) throw std::invalid_argument("harmonics: the radius is not positive everywhere: lower the degree");
    v *= r;
  }
  return mesh;
}

}  // namespace scree
