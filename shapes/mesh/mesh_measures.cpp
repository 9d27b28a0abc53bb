// mesh_measures.cpp: form measures of a closed mesh.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/mesh_measures.h"

#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <tuple>

#include "shapes/mesh/cgal_mesh.h"
#include "shapes/mesh_normalise.h"

namespace scree {
namespace {

Vec3 area_vector(TriangleMesh const& mesh, std::array<int, 3> const& t) {
  return cross(mesh.vertex[t[1]] - mesh.vertex[t[0]], mesh.vertex[t[2]] - mesh.vertex[t[0]]) * 0.5;
}

Box box_of(TriangleMesh const& mesh) {
  double constexpr far = std::numeric_limits<double>::max();
  Box box{{far, far, far}, {-far, -far, -far}};
  for (Vec3 const& v : mesh.vertex)
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], v[k]);
      box.max[k] = std::max(box.max[k], v[k]);
    }
  return box;
}

// Vertices by coordinates, triangles by vertices: CGAL's order follows memory addresses and changes from run to run.
TriangleMesh in_canonical_order(TriangleMesh const& mesh) {
  std::vector<int> order(mesh.vertex.size()), place(mesh.vertex.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    Vec3 const a = mesh.vertex[i], b = mesh.vertex[j];
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  TriangleMesh result;
  for (std::size_t k = 0; k < order.size(); ++k) {
    result.vertex.push_back(mesh.vertex[order[k]]);
    place[order[k]] = static_cast<int>(k);
  }
  for (auto const& [a, b, c] : mesh.triangle) {
    std::array<int, 3> corner{place[a], place[b], place[c]};
    std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
    result.triangle.push_back(corner);
  }
  std::sort(result.triangle.begin(), result.triangle.end());
  return result;
}

}  // namespace

TriangleMesh convex_hull(std::vector<Vec3> const& point) {
  std::vector<cgal::Point> points;
  for (Vec3 const& v : point) points.push_back(cgal::to_point(v));
  cgal::Mesh hull;
  CGAL::convex_hull_3(points.begin(), points.end(), hull);
  if (hull.number_of_faces() < 4) throw std::invalid_argument("convex_hull: the points lie in one plane");
  return in_canonical_order(cgal::from_cgal(hull));
}

double convexity(TriangleMesh const& mesh) {
  return mesh_mass(mesh).volume / mesh_mass(convex_hull(mesh.vertex)).volume;
}

double sphericity(TriangleMesh const& mesh) {
  MeshMass const mass = mesh_mass(mesh);
  return std::cbrt(std::numbers::pi * 36 * mass.volume * mass.volume) / mass.area;
}

double aspect_ratio(TriangleMesh const& mesh) {
  Box const box = box_of(normalised(mesh));
  Vec3 const extent = box.max - box.min;
  return std::max({extent.x, extent.y, extent.z}) / std::min({extent.x, extent.y, extent.z});
}

std::vector<double> dihedral_angles(TriangleMesh const& mesh, double coplanar) {
  std::map<std::pair<int, int>, Vec3> normal_of;  // by directed edge
  for (auto const& t : mesh.triangle)
    for (int k = 0; k < 3; ++k) normal_of[{t[k], t[(k + 1) % 3]}] = normalized(area_vector(mesh, t));
  std::vector<double> angles;
  for (auto const& [edge, normal] : normal_of) {
    if (edge.first > edge.second) continue;
    Vec3 const other = normal_of.at({edge.second, edge.first});
    double const angle = std::atan2(norm(cross(normal, other)), dot(normal, other));
    if (angle > coplanar) angles.push_back(angle);
  }
  return angles;
}

StarKernel star_kernel(TriangleMesh const& mesh, int cells) {
  std::vector<Vec3> normal;
  std::vector<double> offset;
  for (auto const& t : mesh.triangle) {
    Vec3 const n = normalized(area_vector(mesh, t));
    normal.push_back(n);
    offset.push_back(dot(n, mesh.vertex[t[0]]));
  }
  Box const box = box_of(mesh);
  Vec3 const step = (box.max - box.min) / static_cast<double>(cells);
  double best = -std::numeric_limits<double>::max();
  for (int i = 0; i < cells * cells * cells; ++i) {
    Vec3 const cell{i % cells + 0.5, i / cells % cells + 0.5, static_cast<double>(i / (cells * cells)) + 0.5};
    Vec3 const x = box.min + multiply(cell, step);
    double depth = std::numeric_limits<double>::max();
    for (std::size_t f = 0; f < normal.size() && depth > best; ++f)
      depth = std::min(depth, offset[f] - dot(normal[f], x));
    best = std::max(best, depth);
  }
  return {best, best + norm(step) / 2};
}

}  // namespace scree
