// wall_clearance.cpp: see wall_clearance.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/wall_clearance.h"

#include <algorithm>

namespace scree {

double wall_phi(Scene const& scene, int wall, Vec3 point) {
  ShapeRecord const& shape = scene.shape[scene.templates() + wall];
  if (shape.sdf == SdfKind::analytic) return signed_distance(shape.analytic, point, nullptr);
  SdfDataView const all = scene.view().sdf;
  std::size_t const triangle = shape.first_triangle;
  MeshSdf const mesh{all.mesh_node.subspan(shape.first_mesh_node, shape.mesh_nodes),
                     {all.mesh_corner.data + 3 * triangle, 3 * shape.triangles},
                     {all.mesh_normal.data + normals_per_triangle * triangle, normals_per_triangle * shape.triangles}};
  return shape.half_wall > 0 ? sheet_distance(mesh, shape.half_wall, point, nullptr)
                             : mesh_distance(mesh, point, nullptr);
}

double WallClearance::phi(int wall, Vec3 point) const {
  std::size_t const body = scene_.bodies() + wall;
  Vec3 const at = position_ ? (*position_)[body] : scene_.wall[wall].position;
  Quat const turn = orientation_ ? (*orientation_)[body] : scene_.wall[wall].orientation;
  return wall_phi(scene_, wall, transposed_times(to_matrix(turn), point - at));
}

bool WallClearance::is_clear(Vec3 centre, double radius) const {
  bool const in_front = std::all_of(scene_.plane.begin(), scene_.plane.end(),
                                    [&](PlaneRecord const& p) { return dot(p.normal, centre - p.point) >= radius; });
  if (!in_front) return false;
  for (int w = 0; w < static_cast<int>(scene_.wall.size()); ++w)
    if (-phi(w, centre) < radius) return false;
  return true;
}

int WallClearance::wall_around(Vec3 point) const {
  for (PlaneRecord const& p : scene_.plane)
    if (dot(p.normal, point - p.point) < 0) return p.wall;
  for (int w = 0; w < static_cast<int>(scene_.wall.size()); ++w)
    if (phi(w, point) > 0) return scene_.wall[w].wall;
  return -1;
}

}  // namespace scree
