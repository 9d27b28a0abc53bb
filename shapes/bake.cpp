// bake.cpp: see bake.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/bake.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "shapes/grid_shape.h"
#include "shapes/mesh_shape.h"
#include "shapes/phi_batch.h"
#include "shapes/support_points.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

GridFrame frame_around(Shape const& shape, int cells) {
  GridFrame f;
  f.cell = 2 * shape.bounding_radius / cells;
  int* const points[3] = {&f.nx, &f.ny, &f.nz};
  for (int i = 0; i < 3; ++i) {
    double const size = shape.box.max[i] - shape.box.min[i];
    int const across = static_cast<int>(std::ceil(size / f.cell)) + 2;  // at least a cell beyond the box on each side
    *points[i] = across + 1;
    f.origin[i] = 0.5 * (shape.box.min[i] + shape.box.max[i] - across * f.cell);
  }
  return f;
}

// Triangles that face inwards: where creases and edges meet, projection may fold the surface over.
std::vector<int> folded_triangles(PhiBatch const& phi, TriangleMesh const& mesh) {
  std::vector<Vec3> centre, gradient(mesh.triangle.size());
  std::vector<double> value(mesh.triangle.size());
  for (auto const& t : mesh.triangle) centre.push_back((mesh.vertex[t[0]] + mesh.vertex[t[1]] + mesh.vertex[t[2]]) / 3);
  phi(centre, value, gradient);
  std::vector<int> folded;
  for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
    auto const& t = mesh.triangle[i];
    Vec3 const p = mesh.vertex[t[0]];
    if (dot(cross(mesh.vertex[t[1]] - p, mesh.vertex[t[2]] - p), gradient[i]) > 0)
      folded.push_back(static_cast<int>(i));
  }
  return folded;
}

// Corners of folded triangles go to the mean of their neighbours until nothing is folded, or `rounds` times.
void unfold(PhiBatch const& phi, TriangleMesh& mesh, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    std::vector<int> const folded = folded_triangles(phi, mesh);
    if (folded.empty()) return;
    std::vector<char> moves(mesh.vertex.size(), 0);
    for (int i : folded)
      for (int v : mesh.triangle[i]) moves[v] = 1;
    std::vector<Vec3> sum(mesh.vertex.size());
    std::vector<int> count(mesh.vertex.size(), 0);
    for (auto const& t : mesh.triangle)
      for (int k = 0; k < 3; ++k) {  // each neighbour once: every edge is met in both directions
        sum[t[k]] += mesh.vertex[t[(k + 1) % 3]];
        ++count[t[k]];
      }
    for (std::size_t v = 0; v < mesh.vertex.size(); ++v)
      if (moves[v]) mesh.vertex[v] = sum[v] / count[v];
  }
}

// Share of points clearly inside or outside whose sign the mesh gets wrong: a folded surface has no sure inside.
double wrong_signs(PhiBatch const& phi, MeshTree const& tree, double radius, double clear) {
  int constexpr samples = 4000;
  std::vector<Vec3> point = quasi_uniform_directions(samples);
  for (int i = 0; i < samples; ++i) {
    double const u = i * 0.6180339887498949;  // the golden section spreads the depths evenly
    point[i] *= radius * std::cbrt(u - std::floor(u));
  }
  std::vector<double> value(samples);
  phi(point, value, {});
  int wrong = 0;
  for (int i = 0; i < samples; ++i)
    wrong += std::abs(value[i]) > clear && (mesh_distance(tree.sdf(), point[i], nullptr) > 0) != (value[i] > 0);
  return double(wrong) / samples;
}

}  // namespace

Library bake_grid(Library const& library, Shape const& source, int cells, int threads) {
  if (cells < 4 || cells > 400) throw std::invalid_argument("bake_grid: cells must be in 4..400");
  SdfGrid grid;
  grid.frame = frame_around(source, cells);
  GridFrame const& f = grid.frame;
  // A network knows nothing beyond 1.1 bounding radii: there phi goes on with slope 1 from the nearest point it knows.
  double const known = source.is_net() ? 1.1 * source.bounding_radius : 1e300;
  std::vector<Vec3> point;
  std::vector<double> beyond;
  for (int k = 0; k < f.nz; ++k)
    for (int j = 0; j < f.ny; ++j)
      for (int i = 0; i < f.nx; ++i) {
        Vec3 const x = f.origin + Vec3{double(i), double(j), double(k)} * f.cell;
        double const r = norm(x);
        point.push_back(r > known ? x * (known / r) : x);
        beyond.push_back(r > known ? r - known : 0);
      }
  std::vector<double> phi(point.size());
  fast_phi(library, source, threads)(point, phi, {});
  for (std::size_t i = 0; i < phi.size(); ++i) {
    if (!std::isfinite(phi[i])) throw std::runtime_error("phi is not finite near the body");
    grid.value.push_back(static_cast<float>(phi[i] - beyond[i]));
  }
  Library out;
  out.grid.push_back(std::make_shared<SdfGrid const>(std::move(grid)));
  out.shape.push_back(source);
  set_grid(out, 0, out.shape[0]);
  return out;
}

Library bake_mesh(Library const& library, Shape const& source, int cells, int threads) {
  PhiBatch const phi = surface_phi(library, source, threads);
  ZeroSetOptions const options{1.05 * source.bounding_radius, cells, surface_lipschitz(source)};
  ZeroSet fine = refine(phi, find_zero_set(phi, options));
  sharpen_corners(phi, fine);
  unfold(phi, fine.mesh, 30);
  Library out;
  out.mesh.push_back(std::make_shared<MeshTree const>(std::move(fine.mesh)));
  double const wrong = wrong_signs(phi, *out.mesh[0], options.radius, 0.25 * fine.cell);
  if (wrong > 0)
    throw std::runtime_error("the mesh of its zero set folds over (" + std::to_string(100 * wrong) +
                             " % of the points near it on the wrong side): another number of cells may help");
  out.shape.push_back(source);
  set_mesh(out, 0, out.shape[0]);
  return out;
}

}  // namespace scree
