// solids.h: meshes of the hard cases: hexahedra, open sheets, bent tubes, rings.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree::testing {

// Corner k has the low coordinate on axis i where bit i of k is not set.
inline std::array<Vec3, 8> box_corners(Vec3 low, Vec3 high) {
  std::array<Vec3, 8> out;
  for (int k = 0; k < 8; ++k) out[k] = {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
  return out;
}

// Plane-faced solid with the corners of a box that was bent: numbered as in box_corners.
inline TriangleMesh hexahedron(std::array<Vec3, 8> const& corner) {
  TriangleMesh m;
  m.vertex.assign(corner.begin(), corner.end());
  m.triangle = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}

// Square of half size `half` [m] in the plane z = 0, n x n cells of two triangles, facing up; open all round.
inline TriangleMesh sheet_mesh(double half, int n) {
  TriangleMesh m;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) m.vertex.push_back({half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), 0});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      int const at = j * (n + 1) + i, up = at + n + 1;
      m.triangle.push_back({at, at + 1, up + 1});
      m.triangle.push_back({at, up + 1, up});
    }
  return m;
}

// Tube of radius r [m] along a plane curve centre(u) in the plane y = 0, u in 0..1, `rings` circles of `sides` points.
// Closed: the last circle meets the first; else flat ends.
inline TriangleMesh tube(std::function<Vec3(double)> const& centre, double r, int rings, int sides, bool closed) {
  TriangleMesh m;
  int const circles = closed ? rings : rings + 1;
  for (int i = 0; i < circles; ++i) {
    double const u = static_cast<double>(i) / rings, step = 1e-4;
    Vec3 const c = centre(u), along = normalized(centre(u + step) - centre(u - step)), across{0, 1, 0};
    Vec3 const out = cross(across, along);
    for (int k = 0; k < sides; ++k) {
      double const angle = 2 * M_PI * k / sides;
      m.vertex.push_back(c + out * (r * std::cos(angle)) + across * (r * std::sin(angle)));
    }
  }
  auto const at = [&](int i, int k) { return (i % circles) * sides + k % sides; };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      m.triangle.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      m.triangle.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  if (!closed)
    for (int end : {0, rings}) {
      int const middle = static_cast<int>(m.vertex.size());
      m.vertex.push_back(centre(static_cast<double>(end) / rings));
      for (int k = 0; k < sides; ++k) {
        int const a = at(end, k), b = at(end, k + 1);
        m.triangle.push_back(end == 0 ? std::array{middle, a, b} : std::array{middle, b, a});
      }
    }
  if (mesh_mass(m).volume < 0)
    for (auto& t : m.triangle) std::swap(t[1], t[2]);
  return m;
}

// Of a rotation matrix (Shepperd 1978: the largest of the four first, so that nothing is divided by little).
inline Quat rotation_quat(Mat3 const& m) {
  double const r[4] = {m.row[0].x + m.row[1].y + m.row[2].z, m.row[0].x, m.row[1].y, m.row[2].z};
  if (r[0] > std::max({r[1], r[2], r[3]})) {
    double const w = 0.5 * std::sqrt(1 + r[0]);
    return {w, (m.row[2].y - m.row[1].z) / (4 * w), (m.row[0].z - m.row[2].x) / (4 * w),
            (m.row[1].x - m.row[0].y) / (4 * w)};
  }
  int const i = r[1] >= r[2] && r[1] >= r[3] ? 0 : r[2] >= r[3] ? 1 : 2, j = (i + 1) % 3, k = (i + 2) % 3;
  double const x = 0.5 * std::sqrt(1 + m.row[i][i] - m.row[j][j] - m.row[k][k]);
  Vec3 v;
  v[i] = x, v[j] = (m.row[j][i] + m.row[i][j]) / (4 * x), v[k] = (m.row[k][i] + m.row[i][k]) / (4 * x);
  return {(m.row[k][j] - m.row[j][k]) / (4 * x), v.x, v.y, v.z};
}

}  // namespace scree::testing
