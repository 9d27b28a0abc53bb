// box_surface.h: a box as triangles, as many as wanted, for tests of walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/mesh_files.h"

namespace scree::testing {

// Box surface with n x n squares a face, two triangles each, outward.
inline TriangleMesh box_surface(Vec3 low, Vec3 high, int n) {
  TriangleMesh soup;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      int const u = (axis + 1) % 3, v = (axis + 2) % 3;
      auto const corner = [&](int i, int j) {
        Vec3 p;
        p[axis] = side ? high[axis] : low[axis];
        p[u] = i == n ? high[u] : low[u] + (high[u] - low[u]) * i / n;
        p[v] = j == n ? high[v] : low[v] + (high[v] - low[v]) * j / n;
        return p;
      };
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          int const at = static_cast<int>(soup.vertex.size());
          for (Vec3 const& p : {corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)})
            soup.vertex.push_back(p);
          if (side)
            soup.triangle.insert(soup.triangle.end(), {{at, at + 1, at + 2}, {at, at + 2, at + 3}});
          else
            soup.triangle.insert(soup.triangle.end(), {{at, at + 2, at + 1}, {at, at + 3, at + 2}});
        }
    }
  return weld(soup);
}

}  // namespace scree::testing
