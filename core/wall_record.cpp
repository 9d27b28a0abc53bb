// wall_record.cpp: see wall_record.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/wall_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/wall_surface.h"
#include "shapes/terrain_file.h"

namespace scree {
namespace {

WallSolidKind kind_of(ShapeRecord const& shape, WallKind wall) {
  if (shape.sdf == SdfKind::mesh)
    return wall == WallKind::terrain ? WallSolidKind::terrain
           : shape.half_wall > 0     ? WallSolidKind::sheet
                                     : WallSolidKind::mesh;
  switch (shape.analytic.kind) {
    case AnalyticKind::bore:
      return WallSolidKind::bore;
    case AnalyticKind::cylinder:
      return WallSolidKind::cylinder;
    case AnalyticKind::box:
      return WallSolidKind::box;
    case AnalyticKind::capsule:
      return WallSolidKind::capsule;
    case AnalyticKind::funnel:
      return WallSolidKind::funnel;
    default:
      return WallSolidKind::plane;
  }
}

// The scene repeats corners for each triangle; a file has each once. Of a terrain only the surface.
TriangleMesh mesh_of(ShapeRecord const& shape, WallKind wall, Scene const& scene) {
  Vec3 const* const first = scene.mesh_corner.data() + 3 * std::size_t(shape.first_triangle);
  std::vector<Vec3> corner;
  for (int t = 0; t < shape.triangles; ++t)
    if (Vec3 const* const c = first + 3 * t; wall != WallKind::terrain || !is_terrain_side(c[0], c[1], c[2]))
      corner.insert(corner.end(), c, c + 3);
  std::vector<int> order(corner.size()), number(corner.size());
  std::iota(order.begin(), order.end(), 0);
  auto const key = [&](int i) { return std::tuple(corner[i].x, corner[i].y, corner[i].z, i); };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  TriangleMesh mesh;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || corner[order[k]] != corner[order[k - 1]]) mesh.vertex.push_back(corner[order[k]]);
    number[order[k]] = static_cast<int>(mesh.vertex.size()) - 1;
  }
  for (std::size_t i = 0; i < number.size(); i += 3) mesh.triangle.push_back({number[i], number[i + 1], number[i + 2]});
  return mesh;
}

// The rectangle of a box's face, counter-clockwise about the face's normal, in its frame.
std::vector<Vec3> box_face(WallCase const& wall, WallBody const& face) {
  Mat3 const rotation = to_matrix(face.orientation);
  Vec3 const normal = rotation * Vec3{0, 0, 1};
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
  int const u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<Vec3> ring;
  for (auto const& [right, up] : std::array<std::array<bool, 2>, 4>{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}) {
    Vec3 corner = face.position;
    corner[u] = (right ? wall.max : wall.min)[u];
    corner[v] = (up ? wall.max : wall.min)[v];
    ring.push_back(transposed_times(rotation, corner - face.position));
  }
  if (normal[axis] < 0) std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace

ResultsWall recorded_plane(WallCase const& wall, PlaneRecord const& plane) {
  return {wall.name, plane.point, plane.normal, wall.kind == WallKind::cylinder ? wall.radius : 0};
}

std::vector<ResultsWallBody> recorded_wall_bodies(Case const& c, Scene const& scene) {
  std::vector<ResultsWallBody> out;
  for (std::size_t i = 0; i < scene.wall.size(); ++i) {
    WallBody const& body = scene.wall[i];
    WallCase const& wall = c.wall[body.wall];
    ShapeRecord const& shape = scene.shape[scene.templates() + i];
    ResultsWallBody w;
    w.name = wall.name;
    w.kind = kind_of(shape, wall.kind);
    bool const sided = wall.kind == WallKind::box || wall.kind == WallKind::cylinder || w.kind == WallSolidKind::mesh;
    w.inside = sided && wall.inside;
    w.moving = body.motion.has_value();
    w.position = body.position;
    w.orientation = body.orientation;
    if (shape.sdf == SdfKind::mesh) {
      w.mesh = mesh_of(shape, wall.kind, scene);
      w.half_wall = shape.half_wall;
    } else {
      w.formula = shape.analytic;
    }
    if (w.kind == WallSolidKind::plane && wall.kind == WallKind::cylinder) w.mesh = fan(circle(wall.radius));
    if (w.kind == WallSolidKind::plane && wall.kind == WallKind::box) w.mesh = fan(box_face(wall, body));
    out.push_back(std::move(w));
  }
  return out;
}

}  // namespace scree
