// mesh_report.h: what keeps a triangle mesh from bounding one solid, as far as its edges and volume tell.
// Self-intersections need CGAL: check_mesh in shapes/mesh/mesh_check.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree {

struct MeshReport {
  int vertices = 0;  // after welding equal positions
  int triangles = 0;
  int components = 0;                // connected through shared edges
  int degenerate_triangles = 0;      // two equal corners or no area
  int open_edges = 0;                // edges of one triangle
  int non_manifold_edges = 0;        // edges of three or more triangles
  int misoriented_edges = 0;         // two triangles run through the edge in the same direction
  double volume = 0;                 // signed [unit^3]; negative: inside out
  bool self_intersecting = false;    // filled in by check_mesh, where all of the above is fine
  std::vector<std::string> defects;  // what is wrong and the way out, one sentence each; empty: bounds one solid
};

MeshReport report_mesh(TriangleMesh const& mesh);

}  // namespace scree
