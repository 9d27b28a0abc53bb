// triangle_mesh.cpp: see triangle_mesh.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/triangle_mesh.h"

namespace scree {
namespace {

// Integrals over the signed tetrahedron (origin, p, q, r): volume, first and second moments.
struct Moments {
  double volume = 0;
  Vec3 first;
  double second[3][3] = {};  // integral of x_i x_j

  void add_tetrahedron(Vec3 p, Vec3 q, Vec3 r) {
    double const v = dot(p, cross(q, r)) / 6;
    Vec3 const sum = p + q + r;  // the fourth corner is the origin
    volume += v;
    first += sum * (v / 4);
    // Second moment of a tetrahedron: V/20 (sum of corner products + product of corner sums).
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) second[i][j] += v / 20 * (p[i] * p[j] + q[i] * q[j] + r[i] * r[j] + sum[i] * sum[j]);
  }
};

}  // namespace

MeshMass mesh_mass(TriangleMesh const& mesh) {
  MeshMass mass;
  if (mesh.triangle.empty()) return mass;
  // About a point of the mesh: a mesh far from the origin keeps its digits.
  Vec3 const origin = mesh.vertex[mesh.triangle[0][0]];
  Moments m;
  for (auto const& t : mesh.triangle) {
    Vec3 const p = mesh.vertex[t[0]] - origin, q = mesh.vertex[t[1]] - origin, r = mesh.vertex[t[2]] - origin;
    m.add_tetrahedron(p, q, r);
    mass.area += norm(cross(q - p, r - p)) / 2;
  }
  mass.volume = m.volume;
  if (m.volume == 0) return mass;
  Vec3 const c = m.first / m.volume;
  mass.centroid = c + origin;
  double central[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) central[i][j] = central[j][i] = m.second[i][j] - m.volume * c[i] * c[j];
  double const trace = central[0][0] + central[1][1] + central[2][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) mass.inertia.row[i][j] = (i == j ? trace : 0) - central[i][j];
  return mass;
}

}  // namespace scree
