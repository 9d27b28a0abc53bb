// mesh_tree.h: the flat arrays behind kernels/sdf/mesh.h, built from a closed triangle mesh.
// No CGAL: the engine evaluates meshes with this; the truth networks learn from is shapes/mesh/mesh_distance.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/sdf/mesh.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// What lies behind the border of an open surface. `open`: nothing; borders have no normal, and the solid is what lies
// behind the faces. Of a closed mesh both mean the same.
enum class MeshBorder { closed, open };

// A mesh with its bounding volume hierarchy and pseudo-normals. Immutable, so that shapes and libraries share it.
class MeshTree {
 public:
  // `mesh`: closed (but see MeshBorder) and oriented outwards (problems: report_mesh in mesh_report.h), any unit; a
  // triangle without area counts as its edges. Throws std::invalid_argument for a mesh without triangles, a vertex that
  // does not exist or a coordinate that is not finite. Deterministic; O(n log^2 n).
  explicit MeshTree(TriangleMesh mesh, MeshBorder border = MeshBorder::closed);

  TriangleMesh const& mesh() const { return mesh_; }  // in the order it came in
  MeshSdf sdf() const { return {node_, corner_, normal_}; }

 private:
  TriangleMesh mesh_;
  std::vector<MeshNode> node_;
  std::vector<Vec3> corner_, normal_;  // of the triangles in the order of the leaves
};

}  // namespace scree
