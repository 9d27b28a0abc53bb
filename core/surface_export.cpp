// surface_export.cpp: see surface_export.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/surface_export.h"

#include "core/grain_mesh.h"
#include "core/wall_surface.h"

namespace scree {

std::vector<TriangleMesh> grain_meshes(ResultsHeader const& header, Frame const& frame, int triangles) {
  std::vector<TriangleMesh> of_shape;
  for (Shape const& shape : header.library.shape) of_shape.push_back(light_mesh(header.library, shape, triangles));
  std::vector<TriangleMesh> grain;
  for (std::size_t i = 0; i < header.shape.size(); ++i) {
    if (!frame.is_active(i)) continue;
    grain.push_back(of_shape[static_cast<std::size_t>(header.shape[i])]);
    Mat3 const rotation = to_matrix(frame.orientation[i]);
    for (Vec3& v : grain.back().vertex) v = frame.position[i] + rotation * v * header.diameter[i];
  }
  return grain;
}

std::vector<TriangleMesh> wall_meshes(ResultsHeader const& header, Frame const& frame) {
  std::vector<TriangleMesh> wall;
  for (std::size_t i = 0; i < header.wall.size(); ++i) wall.push_back(fan(plane_outline(header, static_cast<int>(i))));
  for (std::size_t i = 0; i < header.wall_body.size(); ++i)
    wall.push_back(posed_wall(header, frame, static_cast<int>(i)));
  return wall;
}

TriangleMesh joined(std::vector<TriangleMesh> const& meshes) {
  TriangleMesh all;
  for (TriangleMesh const& m : meshes) {
    int const first = static_cast<int>(all.vertex.size());
    all.vertex.insert(all.vertex.end(), m.vertex.begin(), m.vertex.end());
    for (auto const& t : m.triangle) all.triangle.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

}  // namespace scree
