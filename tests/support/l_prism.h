// l_prism.h: the smallest closed body with a notch, for tests of meshes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/triangle_mesh.h"

namespace scree::testing {

// {0 <= x <= 2, 0 <= y <= 1} and {0 <= x <= 1, 0 <= y <= 2}, 0 <= z <= 1: 20 triangles, volume 3.
inline TriangleMesh l_prism() {
  TriangleMesh mesh;
  double const outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (double z : {0.0, 1.0})
    for (auto const& p : outline) mesh.vertex.push_back({p[0], p[1], z});
  for (int k = 1; k < 5; ++k) {  // fans from the origin, which sees the whole outline
    mesh.triangle.push_back({0, k + 1, k});
    mesh.triangle.push_back({6, 6 + k, 6 + k + 1});
  }
  for (int k = 0; k < 6; ++k) {
    int const next = (k + 1) % 6;
    mesh.triangle.push_back({k, next, 6 + next});
    mesh.triangle.push_back({k, 6 + next, 6 + k});
  }
  return mesh;
}

inline bool inside_l_prism(Vec3 p) {
  return p.z > 0 && p.z < 1 && p.x > 0 && p.y > 0 && ((p.x < 2 && p.y < 1) || (p.x < 1 && p.y < 2));
}

}  // namespace scree::testing
