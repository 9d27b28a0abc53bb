// grain_mesh.cpp: see grain_mesh.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/grain_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "shapes/star_radii.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

int constexpr marched_cells = 14;  // about 3,000 triangles

// Corners and faces of the icosahedron inscribed in the unit sphere.
TriangleMesh icosahedron() {
  double const g = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh m;
  m.vertex = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  m.triangle = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& v : m.vertex) v = normalized(v);
  return m;
}

// Every face of the icosahedron cut into n^2 triangles; vertices shared between faces are found by their weights.
TriangleMesh geodesic_sphere(int n) {
  TriangleMesh const base = icosahedron();
  TriangleMesh out;
  std::map<std::array<int, 12>, int> known;  // weight of each icosahedron corner -> vertex
  for (std::array<int, 3> const& face : base.triangle) {
    auto const vertex = [&](int i, int j) {
      std::array<int, 12> weight{};
      weight[face[0]] = n - i - j;
      weight[face[1]] = i;
      weight[face[2]] = j;
      auto const [at, made] = known.try_emplace(weight, static_cast<int>(out.vertex.size()));
      if (made) {
        Vec3 sum;
        for (int k = 0; k < 12; ++k) sum += base.vertex[k] * double(weight[k]);
        out.vertex.push_back(normalized(sum));
      }
      return at->second;
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        out.triangle.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j < n - 1) out.triangle.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }
  return out;
}

}  // namespace

TriangleMesh light_mesh(Library const& library, Shape const& shape, int triangles) {
  PhiBatch const phi = surface_phi(library, shape);
  double const reach = 1.1 * shape.bounding_radius;  // beyond it a network may grow spurious solid
  TriangleMesh mesh = geodesic_sphere(std::max(1, static_cast<int>(std::sqrt(triangles / 20.0))));
  std::vector<double> const distance = star_radii(phi, mesh.vertex, reach);
  if (distance.empty())
    return find_zero_set(phi, {.radius = reach, .cells = marched_cells, .lipschitz = surface_lipschitz(shape)}).mesh;
  for (std::size_t i = 0; i < distance.size(); ++i) mesh.vertex[i] *= distance[i];
  return mesh;
}

}  // namespace scree
