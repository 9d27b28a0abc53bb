// mesh_check.h: what keeps a triangle mesh from bounding one solid, and a simple repair.
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
  bool self_intersecting = false;    // only looked for where all of the above is fine
  std::vector<std::string> defects;  // what is wrong and the way out, one sentence each; empty: bounds one solid
};

// `intersections`: also look for self-intersections (about 0.1 s for 10,000 triangles).
MeshReport check_mesh(TriangleMesh const& mesh, bool intersections = true);

// Weld equal vertices, drop degenerate and duplicate triangles, orient, stitch, keep the component of most triangles,
// fill holes of at most `largest_hole` edges, turn the right side out. `actions` (may be null) receives what was done,
// one sentence each. Throws std::runtime_error naming what is left if the result still bounds no solid.
TriangleMesh repair_mesh(TriangleMesh const& mesh, std::vector<std::string>* actions = nullptr, int largest_hole = 30);

}  // namespace scree
