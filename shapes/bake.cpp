// bake.cpp: see bake.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/bake.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
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

// True if points clearly inside or outside, two cells from the vertices, are so for the mesh too: pseudo-normals tell
// the side on embedded surfaces only. Corners, where folds hide, are looked at from more directions.
bool signs_hold(PhiBatch const& phi, TriangleMesh const& mesh, double cell) {
  MeshTree const tree(mesh);
  int constexpr few = 4, many = 100;
  std::vector<Vec3> const direction = quasi_uniform_directions(many);
  std::vector<Vec3> sum(mesh.vertex.size());
  std::vector<double> area(mesh.vertex.size(), 0);
  for (auto const& t : mesh.triangle) {
    Vec3 const p = mesh.vertex[t[0]], n = cross(mesh.vertex[t[1]] - p, mesh.vertex[t[2]] - p);
    for (int v : t) sum[v] += n, area[v] += norm(n);
  }
  std::vector<Vec3> point;
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    bool const corner = norm(sum[v]) < 0.8 * area[v];
    for (int i = 0; i < (corner ? many : few); ++i)  // the few are others at each vertex
      point.push_back(mesh.vertex[v] + direction[corner ? i : (37 * v + 25 * i) % many] * (2 * cell));
  }
  std::vector<double> value(point.size());
  phi(point, value, {});
  for (std::size_t i = 0; i < point.size(); ++i)
    if (std::abs(value[i]) > 0.5 * cell && (mesh_distance(tree.sdf(), point[i], nullptr) > 0) != (value[i] > 0))
      return false;
  return true;
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
  // Whether corners can be recovered without a fold depends on how the grid meets them: finer ones are tried too.
  int constexpr tries = 6;
  Library out;
  for (int more = 0; out.mesh.empty() && more < tries; ++more) {
    ZeroSetOptions const options{1.05 * source.bounding_radius, cells + more, surface_lipschitz(source)};
    ZeroSet fine = refine(phi, find_zero_set(phi, options));
    sharpen_corners(phi, fine);
    unfold(phi, fine.mesh, 30);
    if (signs_hold(phi, fine.mesh, fine.cell))
      out.mesh.push_back(std::make_shared<MeshTree const>(std::move(fine.mesh)));
  }
  if (out.mesh.empty())
    throw std::runtime_error("the mesh of its zero set folds over: another number of cells may help");
  out.shape.push_back(source);
  set_mesh(out, 0, out.shape[0]);
  return out;
}

}  // namespace scree
