// certify_phi.cpp: what a certificate can say about a shape without knowing what it should look like.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/certify_phi.h"

#include <algorithm>
#include <cmath>

#include "shapes/solid_check.h"
#include "shapes/surface_nodes.h"

namespace scree {
namespace {

// Term i of the additive recurrence of Roberts (2018) in three dimensions, in [0, 1): alpha_k = g^-(k+1), g^4 = g + 1.
double roberts(int i, int k) {
  double constexpr alpha[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  double const x = (i + 1) * alpha[k];
  return x - std::floor(x);
}

// Of every vertex: the sum over its triangles of normal times angle.
std::vector<Vec3> corner_normals(TriangleMesh const& mesh) {
  std::vector<Vec3> normal(mesh.vertex.size());
  for (auto const& t : mesh.triangle) {
    Vec3 const* const x[3] = {&mesh.vertex[t[0]], &mesh.vertex[t[1]], &mesh.vertex[t[2]]};
    Vec3 const out = normalized(cross(*x[1] - *x[0], *x[2] - *x[0]));
    for (int k = 0; k < 3; ++k) {
      Vec3 const a = *x[(k + 1) % 3] - *x[k], b = *x[(k + 2) % 3] - *x[k];
      normal[t[k]] += out * std::atan2(norm(cross(a, b)), dot(a, b));
    }
  }
  for (Vec3& n : normal) n = normalized(n);
  return normal;
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return -1;
  double const rank = share * static_cast<double>(values.size() - 1);
  auto const low = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), low, values.end());
  if (low + 1 == values.end()) return *low;
  double const next = *std::min_element(low + 1, values.end());
  return *low + (rank - std::floor(rank)) * (next - *low);
}

SurfacePoints surface_points(TriangleMesh const& mesh, int count) {
  std::vector<double> cumulative;
  double area = 0;
  auto const twice_area = [&](std::array<int, 3> const& t) {
    return cross(mesh.vertex[t[1]] - mesh.vertex[t[0]], mesh.vertex[t[2]] - mesh.vertex[t[0]]);
  };
  for (auto const& t : mesh.triangle) cumulative.push_back(area += norm(twice_area(t)));
  std::vector<Vec3> const corner = corner_normals(mesh);
  SurfacePoints result;
  for (int i = 0; i < count && area > 0; ++i) {
    auto const pick = std::upper_bound(cumulative.begin(), cumulative.end(), roberts(i, 0) * area);
    auto const& t = mesh.triangle[std::min<std::size_t>(pick - cumulative.begin(), cumulative.size() - 1)];
    double const root = std::sqrt(roberts(i, 1)), v = roberts(i, 2);
    auto const between = [&](std::vector<Vec3> const& of) {
      return of[t[0]] * (1 - root) + of[t[1]] * (root * (1 - v)) + of[t[2]] * (root * v);
    };
    result.position.push_back(between(mesh.vertex));
    result.normal.push_back(normalized(twice_area(t)));
    result.interpolated.push_back(normalized(between(corner)));
  }
  return result;
}

void certify_phi(Library const& library, Shape const& shape, CertifyPhiOptions const& options,
                 Certificate& certificate) {
  PhiBatch const phi = fast_phi(library, shape, options.threads);
  ZeroSetOptions zero_set;
  zero_set.radius = 1.1 * shape.bounding_radius;
  ZeroSet const set = find_zero_set(phi, zero_set);
  certificate.components = set.components;
  certificate.euler = set.euler_characteristic;
  SolidCheck const solid = check_solid(phi, set, shape.bounding_radius, options.points);
  certificate.gradient_p1 = solid.gradient_p1, certificate.gradient_p5 = solid.gradient_p5;
  certificate.gradient_p95 = solid.gradient_p95, certificate.gradient_p99 = solid.gradient_p99;
  certificate.falling = solid.falling;
  if (options.nodes <= 0) return;
  SurfaceNodes const nodes = make_surface_nodes(library, shape, options.nodes);
  certificate.gap = nodes.largest_gap;
  certificate.gap_nodes = nodes.n_surface;
}

}  // namespace scree
