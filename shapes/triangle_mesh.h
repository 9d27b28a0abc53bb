// triangle_mesh.h: an indexed triangle mesh, counter-clockwise seen from outside.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "kernels/base/vec.h"

namespace scree {

struct TriangleMesh {
  std::vector<Vec3> vertex;
  std::vector<std::array<int, 3>> triangle;
};

// Volume, centroid and inertia about the centroid of the closed mesh at unit density (divergence theorem, exact for
// the polyhedron; Mirtich 1996 gives the same integrals). Open or inside-out meshes give meaningless or negative
// values.
struct MeshMass {
  double volume = 0;  // [unit^3]
  double area = 0;    // [unit^2]
  Vec3 centroid;      // [unit]
  Mat3 inertia;       // about the centroid, unit density [unit^5]
};
MeshMass mesh_mass(TriangleMesh const& mesh);

}  // namespace scree
