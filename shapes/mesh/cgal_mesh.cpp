// cgal_mesh.cpp: conversion between TriangleMesh and CGAL's half-edge mesh.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/cgal_mesh.h"

#include <stdexcept>
#include <string>

namespace scree::cgal {

Mesh to_cgal(TriangleMesh const& mesh) {
  Mesh result;
  std::vector<Mesh::Vertex_index> vertex;
  vertex.reserve(mesh.vertex.size());
  for (Vec3 const& v : mesh.vertex) vertex.push_back(result.add_vertex(to_point(v)));
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t) {
    auto const& [a, b, c] = mesh.triangle[t];
    if (result.add_face(vertex[a], vertex[b], vertex[c]) == Mesh::null_face())
      throw std::invalid_argument("triangle " + std::to_string(t) +
                                  " does not fit a manifold surface: repair the mesh (scree-shape import)");
  }
  return result;
}

TriangleMesh from_cgal(Mesh const& mesh) {
  TriangleMesh result;
  std::vector<int> index(mesh.number_of_vertices() + mesh.number_of_removed_vertices(), -1);
  for (auto v : mesh.vertices()) {
    index[v] = static_cast<int>(result.vertex.size());
    result.vertex.push_back(to_vec(mesh.point(v)));
  }
  for (auto f : mesh.faces()) {
    std::array<int, 3> corner{};
    int k = 0;
    for (auto v : mesh.vertices_around_face(mesh.halfedge(f))) corner[k++] = index[v];
    result.triangle.push_back(corner);
  }
  return result;
}

}  // namespace scree::cgal
