// wall_edges.cpp: see wall_edges.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/wall_edges.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace scree {
namespace {

struct Uses {
  int count = 0;
  Vec3 first, second;  // unit normals of two of its triangles
  Vec3 inwards;        // from the edge to the third corner of the first triangle
  Vec3 over;           // from the edge to the third corner of the second triangle
};

Vec3 unit_normal(TriangleMesh const& mesh, std::array<int, 3> const& t) {
  Vec3 const area = cross(mesh.vertex[t[1]] - mesh.vertex[t[0]], mesh.vertex[t[2]] - mesh.vertex[t[0]]);
  double const size = norm(area);
  return size > 0 ? area / size : Vec3{};
}

}  // namespace

std::vector<WallEdge> sharp_wall_edges(TriangleMesh const& mesh, double angle, bool both_sides) {
  std::map<std::pair<int, int>, Uses> uses;
  for (auto const& t : mesh.triangle) {
    Vec3 const normal = unit_normal(mesh, t);
    if (!(norm2(normal) > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      Uses& u = uses[std::minmax(t[k], t[(k + 1) % 3])];
      Vec3 const third = mesh.vertex[t[(k + 2) % 3]] - mesh.vertex[t[k]];
      if (++u.count == 1)
        u.first = normal, u.inwards = third;
      else
        u.second = normal, u.over = third;
    }
  }
  std::vector<WallEdge> out;
  for (auto const& [key, u] : uses) {
    WallEdge edge{mesh.vertex[key.first], mesh.vertex[key.second], {}, u.count == 1};
    Vec3 const along = edge.to - edge.from;
    if (u.count == 1) {
      if (!both_sides) continue;  // where an open surface ends, nothing is solid
      Vec3 const in = u.inwards - along * (dot(u.inwards, along) / std::max(norm2(along), 1e-300));
      edge.outward = normalized(-in);
    } else {
      double const turn = std::atan2(norm(cross(u.first, u.second)), dot(u.first, u.second));
      bool const convex = dot(u.first, u.over) < 0;
      if (u.count == 2 && (turn < angle || !(convex || both_sides))) continue;
      edge.outward = normalized((u.first + u.second) * (convex ? 1 : -1));
    }
    out.push_back(edge);
  }
  return out;
}

EdgePoints points_along(std::vector<WallEdge> const& edges, double spacing) {
  EdgePoints out;
  for (WallEdge const& e : edges) {
    double const length = norm(e.to - e.from);
    int const n = std::max(1, static_cast<int>(std::ceil(length / spacing)));
    for (int i = 0; i < n; ++i) {
      out.position.push_back(e.from + (e.to - e.from) * ((i + 0.5) / n));
      out.outward.push_back(e.outward);
      out.length.push_back(length / n);
    }
  }
  return out;
}

}  // namespace scree
