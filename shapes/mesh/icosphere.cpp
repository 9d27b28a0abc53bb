// icosphere.cpp: the unit sphere as a subdivided icosahedron.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/icosphere.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <stdexcept>

namespace scree {
namespace {

TriangleMesh icosahedron() {
  double const g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertex = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangle = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3& v : mesh.vertex) v = normalized(v);
  return mesh;
}

TriangleMesh subdivided(TriangleMesh mesh) {
  std::map<std::pair<int, int>, int> middle_of;
  auto const middle = [&](int a, int b) {
    auto const [where, is_new] =
        middle_of.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.vertex.size()));
    if (is_new) mesh.vertex.push_back(normalized(mesh.vertex[a] + mesh.vertex[b]));
    return where->second;
  };
  std::vector<std::array<int, 3>> finer;
  finer.reserve(4 * mesh.triangle.size());
  for (auto const& [a, b, c] : mesh.triangle) {
    int const ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  mesh.triangle = std::move(finer);
  return mesh;
}

}  // namespace

TriangleMesh icosphere(int subdivisions) {
  if (subdivisions < 0 || subdivisions > 8) throw std::invalid_argument("icosphere: subdivisions must be 0..8");
  TriangleMesh mesh = icosahedron();
  for (int k = 0; k < subdivisions; ++k) mesh = subdivided(std::move(mesh));
  return mesh;
}

}  // namespace scree
