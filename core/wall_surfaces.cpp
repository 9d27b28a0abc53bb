// wall_surfaces.cpp: see wall_surfaces.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/wall_surfaces.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "shapes/mesh_files.h"

namespace scree {
namespace {

int constexpr around = 90;  // facets of a turn
double constexpr pi = std::numbers::pi;

using Profile = std::vector<std::pair<double, double>>;  // (r, z), the solid to the left of its direction

// Surface of revolution about z. Points on the axis become fans; no area where both ends lie on it.
TriangleMesh revolve(Profile const& profile, bool closed) {
  TriangleMesh mesh;
  int const n = static_cast<int>(profile.size());
  for (auto const& [r, z] : profile)
    for (int k = 0; k < around; ++k) {
      double const angle = 2 * pi * k / around;
      mesh.vertex.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  for (int i = 0; i + 1 < n + closed; ++i) {
    int const j = (i + 1) % n;
    for (int k = 0; k < around; ++k) {
      int const l = (k + 1) % around;
      int const a = i * around + k, b = i * around + l, c = j * around + l, d = j * around + k;
      if (profile[i].first > 0) mesh.triangle.push_back({a, b, c});
      if (profile[j].first > 0) mesh.triangle.push_back({a, c, d});
    }
  }
  return mesh;
}

// Appends the arc about (r, z) from angle `from` to `to`, 0 along +r, a quarter turn along +z.
void arc(Profile& profile, double r, double z, double radius, double from, double to) {
  int constexpr steps = 8;
  for (int i = 0; i <= steps; ++i) {
    double const angle = from + (to - from) * i / steps;
    profile.emplace_back(std::max(0.0, r + radius * std::cos(angle)), z + radius * std::sin(angle));
  }
}

TriangleMesh box_surface(Vec3 h) {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i) m.vertex.push_back({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
  m.triangle = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}

TriangleMesh square(double half) {
  TriangleMesh m;
  m.vertex = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  m.triangle = {{0, 1, 2}, {0, 2, 3}};
  return m;
}

TriangleMesh formula_surface(AnalyticSdf const& s, double reach) {
  Vec3 const h = s.half_size;
  Profile p;
  switch (s.kind) {
    case AnalyticKind::box:
      return box_surface(h);
    case AnalyticKind::plane:
      return square(reach);
    case AnalyticKind::cylinder:
      return revolve({{0, -h.z}, {h.x, -h.z}, {h.x, h.z}, {0, h.z}}, false);
    case AnalyticKind::bore:
      return revolve({{h.x, h.z}, {h.x, -h.z}}, false);
    case AnalyticKind::capsule:
      arc(p, 0, -h.z, h.x, -pi / 2, 0);
      arc(p, 0, h.z, h.x, 0, pi / 2);
      return revolve(p, false);
    case AnalyticKind::funnel: {
      double const slant = std::atan2(2 * h.z, h.y - h.x);  // of the middle line
      arc(p, h.x, -h.z, s.half_wall, slant + pi / 2, slant + 3 * pi / 2);
      arc(p, h.y, h.z, s.half_wall, slant - pi / 2, slant + pi / 2);
      return revolve(p, true);
    }
    default:
      return {};
  }
}

TriangleMesh mesh_surface(ShapeRecord const& shape, Scene const& scene) {
  TriangleMesh mesh;
  for (int t = 0; t < shape.triangles; ++t) {
    int const first = static_cast<int>(mesh.vertex.size());
    for (int k = 0; k < 3; ++k)
      mesh.vertex.push_back(scene.mesh_corner[3 * (std::size_t(shape.first_triangle) + t) + k]);
    mesh.triangle.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

bool lets_look_through(WallCase const& w) {
  switch (w.kind) {
    case WallKind::cone:
    case WallKind::plane:
      return true;
    case WallKind::box:
    case WallKind::cylinder:
      return w.inside;
    case WallKind::mesh:
      return w.inside || w.thickness > 0;
    case WallKind::capsule:
    case WallKind::terrain:
      return false;
  }
  return false;
}

}  // namespace

std::vector<ResultsSurface> wall_surfaces(Case const& c, Scene const& scene) {
  std::vector<ResultsSurface> out;
  for (std::size_t i = 0; i < scene.wall.size(); ++i) {
    WallBody const& body = scene.wall[i];
    WallCase const& wall = c.wall[body.wall];
    ShapeRecord const& shape = scene.shape[scene.templates() + i];
    bool const formula = shape.sdf == SdfKind::analytic;
    if (formula && wall.kind == WallKind::cylinder && shape.analytic.kind == AnalyticKind::plane) continue;
    TriangleMesh mesh = formula ? formula_surface(shape.analytic, body.reach) : weld(mesh_surface(shape, scene));
    Mat3 const turn = to_matrix(body.orientation);
    for (Vec3& v : mesh.vertex) v = body.position + turn * v;
    out.push_back({wall.name, std::move(mesh), lets_look_through(wall)});
  }
  return out;
}

}  // namespace scree
