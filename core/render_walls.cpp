// render_walls.cpp: see render_walls.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/render_walls.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/wall_surface.h"
#include "shapes/wall_edges.h"

namespace scree {
namespace {

double constexpr sharp = std::numbers::pi / 5;

bool meets(MeshNode const& node, Ray const& ray, double limit) {
  double from = 0, to = limit;
  for (int k = 0; k < 3; ++k) {
    double const inverse = 1 / ray.direction[k];  // infinite for rays along a face: the comparisons still hold
    double a = (node.min[k] - ray.origin[k]) * inverse, b = (node.max[k] - ray.origin[k]) * inverse;
    if (a > b) std::swap(a, b);
    from = a > from ? a : from;
    to = b < to ? b : to;
  }
  return from <= to * (1 + 1e-12) + 1e-12;
}

struct Crossing {
  double distance;
  double u, v;  // weights of the second and third corner
};

// Moeller, Trumbore (1997).
std::optional<Crossing> crossing(Vec3 const* c, Ray const& ray) {
  Vec3 const e1 = c[1] - c[0], e2 = c[2] - c[0], p = cross(ray.direction, e2);
  double const determinant = dot(e1, p);
  if (determinant == 0) return {};
  Vec3 const s = ray.origin - c[0], q = cross(s, e1);
  double const u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant;
  if (u < -1e-12 || v < -1e-12 || u + v > 1 + 1e-12) return {};
  return Crossing{dot(e2, q) / determinant, u, v};
}

// visit(triangle, crossing) for triangles in front of the origin and nearer than `limit`, which it may shorten.
template <class Visit>
void for_crossings(MeshSdf const& mesh, Ray const& ray, double& limit, Visit const& visit) {
  int stack[mesh_tree_depth], depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    int const index = stack[--depth];
    MeshNode const& node = mesh.node[index];
    if (!meets(node, ray, limit)) continue;
    if (node.count == 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (int t = node.first; t < node.first + node.count; ++t)
      if (auto const c = crossing(&mesh.corner[3 * std::size_t(t)], ray); c && c->distance > 0 && c->distance < limit)
        visit(t, *c);
  }
}

Vec3 unit(Vec3 v) { return norm2(v) > 0 ? normalized(v) : v; }

Vec3 smooth_normal(MeshSdf const& mesh, int triangle, Crossing const& c) {
  Vec3 const* const n = &mesh.normal[normals_per_triangle * std::size_t(triangle)];
  Vec3 const face = unit(n[0]);
  Vec3 corner[3];
  for (int k = 0; k < 3; ++k) {
    corner[k] = unit(n[4 + k]);
    if (dot(corner[k], face) < 0.8) return face;  // a sharp edge, or a border
  }
  return normalized(corner[0] * (1 - c.u - c.v) + corner[1] * c.u + corner[2] * c.v);
}

// Grains are within it or on both sides: it must not hide them.
bool is_glass(ResultsWallBody const& wall) {
  bool const open = wall.kind == WallSolidKind::plane || wall.kind == WallSolidKind::bore ||
                    wall.kind == WallSolidKind::funnel || wall.kind == WallSolidKind::sheet;
  return open || wall.inside;
}

}  // namespace

RenderWalls::RenderWalls(ResultsHeader const& header, Frame const& frame) {
  for (std::size_t w = 0; w < header.wall_body.size(); ++w) {
    TriangleMesh const mesh = posed_wall(header, frame, static_cast<int>(w));
    if (mesh.triangle.empty()) continue;
    bool const glass = is_glass(header.wall_body[w]);
    walls_.push_back({MeshTree(mesh, MeshBorder::open), glass});
    if (glass)
      for (WallEdge const& e : sharp_wall_edges(mesh, sharp, true)) edges_.push_back({e.from, e.to});
    for (Vec3 const& v : mesh.vertex) {
      if (!bounds_) bounds_ = Box{v, v};
      for (int k = 0; k < 3; ++k) {
        bounds_->min[k] = std::min(bounds_->min[k], v[k]);
        bounds_->max[k] = std::max(bounds_->max[k], v[k]);
      }
    }
  }
}

std::optional<RenderWalls::Hit> RenderWalls::first(Ray const& ray, double limit) const {
  std::optional<Hit> best;
  for (Wall const& w : walls_) {
    if (w.glass) continue;
    MeshSdf const mesh = w.tree.sdf();
    for_crossings(mesh, ray, limit, [&](int t, Crossing const& c) {
      limit = c.distance;
      Vec3 const n = smooth_normal(mesh, t, c);
      best = Hit{c.distance, dot(n, ray.direction) > 0 ? -n : n};
    });
  }
  return best;
}

double RenderWalls::glass(Ray const& ray, double distance) const {
  double passes = 1;
  for (Wall const& w : walls_) {
    if (!w.glass) continue;
    MeshSdf const mesh = w.tree.sdf();
    std::vector<double> seen;  // a ray through an edge crosses both of its triangles
    for_crossings(mesh, ray, distance, [&](int t, Crossing const& c) {
      for (double const s : seen)
        if (std::abs(s - c.distance) < 1e-9 * distance) return;
      seen.push_back(c.distance);
      double const facing = std::abs(dot(smooth_normal(mesh, t, c), ray.direction));
      passes *= 1 - (0.05 + 0.30 * std::pow(1 - facing, 3.0));  // more at grazing incidence
    });
  }
  return 1 - passes;
}

}  // namespace scree
