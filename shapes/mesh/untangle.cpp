// untangle.cpp: see untangle.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/untangle.h"

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "shapes/mesh/cgal_mesh.h"

namespace scree {

Untangled untangle(TriangleMesh& mesh, int rounds) {
  Untangled out;
  std::vector<Vec3> const before = mesh.vertex;
  std::vector<char> moved(mesh.vertex.size(), 0);
  for (int round = 0; round <= rounds && !out.is_simple; ++round) {
    std::vector<std::pair<cgal::Mesh::Face_index, cgal::Mesh::Face_index>> cuts;
    CGAL::Polygon_mesh_processing::self_intersections(cgal::to_cgal(mesh), std::back_inserter(cuts));
    out.is_simple = cuts.empty();
    if (out.is_simple || round == rounds) break;
    std::vector<char> tangled(mesh.vertex.size(), 0);
    for (auto const& [a, b] : cuts)  // faces have the triangles' numbers
      for (std::size_t const t : {std::size_t(a), std::size_t(b)})
        for (int const v : mesh.triangle[t]) tangled[v] = moved[v] = 1;
    std::vector<Vec3> sum(mesh.vertex.size());
    std::vector<int> neighbours(mesh.vertex.size(), 0);  // each is met twice, once a triangle at their edge and side
    for (auto const& t : mesh.triangle)
      for (int k = 0; k < 3; ++k) {
        sum[t[k]] += mesh.vertex[t[(k + 1) % 3]] + mesh.vertex[t[(k + 2) % 3]];
        neighbours[t[k]] += 2;
      }
    for (std::size_t v = 0; v < mesh.vertex.size(); ++v)
      if (tangled[v]) mesh.vertex[v] = sum[v] / neighbours[v];
  }
  for (std::size_t v = 0; v < mesh.vertex.size(); ++v) {
    out.vertices += moved[v];
    out.farthest = std::max(out.farthest, norm(mesh.vertex[v] - before[v]));
  }
  return out;
}

}  // namespace scree
