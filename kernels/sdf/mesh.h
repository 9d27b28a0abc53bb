// mesh.h: signed distance to a triangle mesh through a bounding volume hierarchy in flat arrays, in double.
// phi > 0 inside; the gradient has length 1 and points inwards. The arrays are built on the host: shapes/mesh_tree.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"

namespace scree {

// A leaf holds the triangles [first, first + count); an inner node (count 0) has one child right behind it and the
// other at `right`.
struct MeshNode {
  Vec3 min, max;
  int right = 0;
  int first = 0, count = 0;
};

int constexpr mesh_leaf_size = 4;    // triangles: a leaf then costs about as much as the boxes above it
int constexpr mesh_tree_depth = 48;  // of the stack; halving 2^28 triangles needs 27

// Normals of a triangle, in the order of the features of closest_on_triangle.
int constexpr normals_per_triangle = 7;

// One mesh. Corners are repeated for each triangle (240 bytes a triangle in all), so that a leaf is read in one piece.
struct MeshSdf {
  Span<const MeshNode> node;  // node[0] is the root
  Span<const Vec3> corner;    // (3 triangles), counter-clockwise seen from outside
  Span<const Vec3> normal;    // (7 triangles), outward, any length: face, edges ab bc ca, corners a b c; on edges the
                              // sum of both faces, on corners the angle-weighted sum (Baerentzen, Aanaes 2005)
};

struct TrianglePoint {
  Vec3 point;
  int feature = 0;  // 0: face; 1, 2, 3: edge ab, bc, ca; 4, 5, 6: corner a, b, c
};

// Closest point of the triangle a b c to x (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
SCREE_HD inline TrianglePoint closest_on_triangle(Vec3 a, Vec3 b, Vec3 c, Vec3 x) {
  Vec3 const ab = b - a, ac = c - a, ax = x - a;
  double const d1 = dot(ab, ax), d2 = dot(ac, ax);
  if (d1 <= 0 && d2 <= 0) return {a, 4};
  Vec3 const bx = x - b;
  double const d3 = dot(ab, bx), d4 = dot(ac, bx);
  if (d3 >= 0 && d4 <= d3) return {b, 5};
  Vec3 const cx = x - c;
  double const d5 = dot(ab, cx), d6 = dot(ac, cx);
  if (d6 >= 0 && d5 <= d6) return {c, 6};
  double const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + ab * (d1 / (d1 - d3)), 1};
  double const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + ac * (d2 / (d2 - d6)), 3};
  double const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return {b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 2};
  double const scale = 1 / (va + vb + vc);
  return {a + ab * (vb * scale) + ac * (vc * scale), 0};
}

namespace detail {

SCREE_HD inline double distance2_to_box(MeshNode const& node, Vec3 x) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    double const low = node.min[i] - x[i], high = x[i] - node.max[i];
    double const out = low > high ? low : high;
    if (out > 0) sum += out * out;
  }
  return sum;
}

struct MeshHit {
  Vec3 point;
  double distance2 = 1e300;
  int triangle = -1, feature = 0;
};

// Closest point of the surface; of equally close ones the first in the order of the walk.
SCREE_HD inline MeshHit closest_on_mesh(MeshSdf const& mesh, Vec3 x) {
  struct Waiting {
    int node;
    double distance2;
  };
  Waiting stack[mesh_tree_depth];
  int depth = 0;
  MeshHit best;
  stack[depth++] = {0, distance2_to_box(mesh.node[0], x)};
  while (depth > 0) {
    Waiting const next = stack[--depth];
    if (!(next.distance2 < best.distance2)) continue;
    MeshNode const& node = mesh.node[next.node];
    if (node.count == 0) {
      Waiting near{next.node + 1, distance2_to_box(mesh.node[next.node + 1], x)};
      Waiting far{node.right, distance2_to_box(mesh.node[node.right], x)};
      if (far.distance2 < near.distance2) {
        Waiting const other = near;
        near = far, far = other;
      }
      stack[depth++] = far;
      stack[depth++] = near;
      continue;
    }
    for (int t = node.first; t < node.first + node.count; ++t) {
      Vec3 const* const c = &mesh.corner[3 * std::size_t(t)];
      TrianglePoint const hit = closest_on_triangle(c[0], c[1], c[2], x);
      double const distance2 = norm2(x - hit.point);
      if (distance2 < best.distance2) best = {hit.point, distance2, t, hit.feature};
    }
  }
  return best;
}

}  // namespace detail

// phi and, unless null, its gradient at x, in the unit of the mesh. The sign comes from the pseudo-normal of the
// feature that the closest point lies on: right for any closed, oriented mesh, convex or not. On the medial axis the
// gradient is that of one of the closest points; nearer to the surface than 1e-10 of the mesh it is the pseudo-normal.
// An open surface is solid behind its faces; a point whose closest one lies on a border is outside (MeshTree).
// Cost near the surface: 3 us for 17,000 triangles (one core of the development machine).
SCREE_HD inline double mesh_distance(MeshSdf const& mesh, Vec3 x, Vec3* gradient) {
  detail::MeshHit const hit = detail::closest_on_mesh(mesh, x);
  Vec3 const gap = x - hit.point, out = mesh.normal[normals_per_triangle * std::size_t(hit.triangle) + hit.feature];
  double const distance = std::sqrt(hit.distance2);
  bool const outside = !(dot(gap, out) < 0);  // a border without a normal has no inside
  if (gradient) {
    double const tiny = 1e-10 * norm(mesh.node[0].max - mesh.node[0].min);
    *gradient = distance > tiny ? gap * ((outside ? -1 : 1) / distance) : normalized(-out);
  }
  return outside ? -distance : distance;
}

// The same for a sheet: everything within half_wall of the surface is solid, whichever way its triangles face. Borders
// are round.
SCREE_HD inline double sheet_distance(MeshSdf const& mesh, double half_wall, Vec3 x, Vec3* gradient) {
  detail::MeshHit const hit = detail::closest_on_mesh(mesh, x);
  double const distance = std::sqrt(hit.distance2);
  if (gradient)
    *gradient = distance > 0 ? (x - hit.point) * (-1 / distance)
                             : normalized(-mesh.normal[normals_per_triangle * std::size_t(hit.triangle)]);
  return half_wall - distance;
}

}  // namespace scree
