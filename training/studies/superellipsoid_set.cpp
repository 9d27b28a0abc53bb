// superellipsoid_set.cpp: the 125 superellipsoids of the benchmark set.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/superellipsoid_set.h"

#include <fmt/format.h>

#include "shapes/analytic_shapes.h"
#include "shapes/phi_batch.h"
#include "shapes/zero_set.h"

namespace scree {

SetSuperellipsoid set_superellipsoid(double elongation, double flatness, double exponent) {
  SetSuperellipsoid result{elongation, flatness, exponent,
                           make_superellipsoid({1, elongation, elongation * flatness}, exponent, exponent)};
  result.shape.name = fmt::format("superellipsoid/e{:.1f}-ei{:.2f}-fi{:.2f}", exponent, elongation, flatness);
  return result;
}

std::vector<SetSuperellipsoid> superellipsoid_set() {
  std::vector<SetSuperellipsoid> set;
  for (double exponent : superellipsoid_exponents)
    for (double elongation : superellipsoid_ratios)
      for (double flatness : superellipsoid_ratios) set.push_back(set_superellipsoid(elongation, flatness, exponent));
  return set;
}

TriangleMesh superellipsoid_mesh(Shape const& shape, int cells) {
  // That of equal axes, stretched: a mesh of the flat body itself would lose its thin rims between the cells.
  AnalyticSdf const& flat = shape.analytic;
  Shape const even = make_superellipsoid({1, 1, 1}, flat.exponent_ns, flat.exponent_ew);
  PhiBatch const phi = surface_phi({}, even);
  TriangleMesh mesh = refine(phi, find_zero_set(phi, {1.05 * even.bounding_radius, cells, 1.0})).mesh;
  for (Vec3& v : mesh.vertex)
    for (int k = 0; k < 3; ++k) v[k] *= flat.half_size[k] / even.analytic.half_size[k];
  return mesh;
}

Body superellipsoid_body(SetSuperellipsoid const& s) {
  Body body = make_body(s.shape.name, s.shape);
  body.mesh = superellipsoid_mesh(s.shape, 32);
  return body;
}

}  // namespace scree
