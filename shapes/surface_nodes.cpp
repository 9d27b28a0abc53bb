// surface_nodes.cpp: see surface_nodes.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/surface_nodes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "shapes/node_placement.h"
#include "shapes/point_blocks.h"
#include "shapes/support_points.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

// A mesh with about `triangles` after one refinement. Marching tetrahedra leave about ten triangles a surface cell.
ZeroSet fine_mesh(PhiBatch const& phi, Shape const& shape, double triangles) {
  double const radius = 1.05 * shape.bounding_radius;
  double const area = shape.area > 0 ? shape.area : 4;
  double const cell = std::sqrt(10 * area / (triangles / 4));
  int const cells = std::clamp(static_cast<int>(2 * radius / cell), 12, 400);
  ZeroSet fine = refine(phi, find_zero_set(phi, {radius, cells, surface_lipschitz(shape)}));
  sharpen_corners(phi, fine);
  return fine;
}

// The smallest relative change of the areas that makes sum A n = 0 and sum A x.n = 3 V hold exactly:
// A (1 + c . lambda) with c = (n, x.n), sum A c (1 + c . lambda) = (0, 3 V).
void close_areas(SurfaceNodes& nodes, double volume) {
  Eigen::Matrix4d normal_matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d missing(0, 0, 0, 3 * volume);
  auto const row = [&](int a) {
    Vec3 const n = nodes.normal[a];
    return Eigen::Vector4d(n.x, n.y, n.z, dot(nodes.position[a], n));
  };
  int const count = static_cast<int>(nodes.position.size());
  for (int a = 0; a < count; ++a) {
    normal_matrix += nodes.area[a] * row(a) * row(a).transpose();
    missing -= nodes.area[a] * row(a);
  }
  Eigen::Vector4d const lambda = normal_matrix.colPivHouseholderQr().solve(missing);
  // Half the area is the most a node may lose: a correction that large means a wrong volume, which the gates report.
  for (int a = 0; a < count; ++a) nodes.area[a] *= std::max(1 + row(a).dot(lambda), 0.5);
}

// Append points with areas and normals, in blocks of their own.
void append_blocks(SurfaceNodes& nodes, std::vector<Vec3> const& position, std::vector<double> const& area,
                   std::vector<Vec3> const& normal) {
  PointBlocks const blocks = make_point_blocks(position, nodes_per_block);
  int const base = static_cast<int>(nodes.position.size());
  for (int i : blocks.order) {
    nodes.position.push_back(position[i]);
    nodes.area.push_back(area[i]);
    nodes.normal.push_back(normal[i]);
  }
  if (nodes.block_first.empty()) nodes.block_first.push_back(0);
  for (std::size_t b = 0; b < blocks.centre.size(); ++b) {
    nodes.block_centre.push_back(blocks.centre[b]);
    nodes.block_radius.push_back(blocks.radius[b]);
    nodes.block_first.push_back(base + blocks.first[b + 1]);
  }
}

// Of a core node below the surface [d]. Half-way to the centre every star-shaped body has more, be it a plate 1:40;
// bodies with a hole or a bend have core places outside themselves, where a node would push at what is not there.
double constexpr core_depth = 0.01;

void append_core(SurfaceNodes& nodes, PhiBatch const& phi) {
  std::vector<Vec3> position;
  std::vector<double> area;
  double total = 0;
  for (int a = 0; a < nodes.n_surface; ++a) {
    total += nodes.area[a];
    if (a % core_every != 0) continue;
    position.push_back(nodes.position[a] * core_scale);
    area.push_back(nodes.area[a] * core_every);
  }
  position.push_back({});
  area.push_back(total);
  std::vector<double> depth(position.size());
  phi(position, depth, {});
  std::size_t kept = 0;
  for (std::size_t i = 0; i < position.size(); ++i)
    if (depth[i] > core_depth) position[kept] = position[i], area[kept++] = area[i];
  position.resize(kept);
  area.resize(kept);
  if (kept > 0) append_blocks(nodes, position, area, std::vector<Vec3>(kept));
}

}  // namespace

double largest_gap(PhiBatch const& phi, std::vector<Vec3> const& dense, double step, SurfaceNodes const& nodes,
                   int directions) {
  // Turned against the directions by which nodes were placed, and of another number.
  std::vector<Vec3> const direction = quasi_uniform_directions(directions, 1.0);
  std::vector<Vec3> const surface(nodes.position.begin(), nodes.position.begin() + nodes.n_surface);
  std::vector<int> const top = extreme_points(dense, direction), mine = extreme_points(surface, direction);
  std::vector<Vec3> start;
  for (int i : top) start.push_back(dense[i]);
  std::vector<Vec3> const summit = climb(phi, start, direction, step, 8);
  double worst = 0;
  for (std::size_t k = 0; k < direction.size(); ++k)
    worst = std::max(worst, dot(direction[k], summit[k] - surface[mine[k]]));
  return worst;
}

SurfaceNodes make_surface_nodes(PhiBatch const& phi, Shape const& shape, int count, SurfaceNodeOptions const& options) {
  ZeroSet const fine = fine_mesh(phi, shape, std::max(40000.0, 14.0 * count));
  PlacementOptions placement;
  placement.count = count;
  PlacedNodes const placed = place_nodes(phi, fine, placement);
  SurfaceNodes nodes;
  std::vector<double> area;
  std::vector<Vec3> normal;
  for (Vec3 v : placed.area_vector) {
    area.push_back(norm(v));
    normal.push_back(v / area.back());
  }
  append_blocks(nodes, placed.position, area, normal);
  nodes.n_surface = static_cast<int>(nodes.position.size());
  close_areas(nodes, shape.volume);
  double total = 0;
  for (double a : nodes.area) total += a;
  nodes.spacing = std::sqrt(total / nodes.n_surface);
  if (options.measure_gap) nodes.largest_gap = largest_gap(phi, fine.mesh.vertex, 0.5 * fine.cell, nodes);
  append_core(nodes, phi);
  return nodes;
}

SurfaceNodes make_surface_nodes(Library const& library, Shape const& shape, int count,
                                SurfaceNodeOptions const& options) {
  return make_surface_nodes(surface_phi(library, shape), shape, count, options);
}

DenseSurface make_dense_surface(PhiBatch const& phi, Shape const& shape, int count) {
  // A closed mesh has half as many vertices as triangles. Another grid than the nodes', so that the two do not share
  // their blind spots.
  ZeroSet const fine = fine_mesh(phi, shape, 3.0 * count);
  DenseSurface dense{fine.mesh.vertex, fine.normal, std::vector<double>(fine.mesh.vertex.size(), 0)};
  for (auto const& t : fine.mesh.triangle) {
    Vec3 const p = dense.position[t[0]];
    double const third = norm(cross(dense.position[t[1]] - p, dense.position[t[2]] - p)) / 6;
    for (int v : t) dense.area[v] += third;
  }
  std::vector<Vec3> const direction = quasi_uniform_directions(2000, 2.0);
  std::vector<Vec3> start;
  for (int i : extreme_points(dense.position, direction)) start.push_back(dense.position[i]);
  std::vector<Vec3> const summit = climb(phi, start, direction, 0.5 * fine.cell, 12);
  dense.position.insert(dense.position.end(), summit.begin(), summit.end());
  dense.normal.insert(dense.normal.end(), direction.begin(), direction.end());
  dense.area.resize(dense.position.size(), 0);
  return dense;
}

}  // namespace scree
