// mesh_check.h: what keeps a triangle mesh from bounding one solid, and a simple repair.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shapes/mesh_report.h"

namespace scree {

// report_mesh and, with `intersections`, also a look for self-intersections (about 0.1 s for 10,000 triangles).
MeshReport check_mesh(TriangleMesh const& mesh, bool intersections = true);

// Weld equal vertices, drop degenerate and duplicate triangles, orient, stitch, keep the component of most triangles,
// fill holes of at most `largest_hole` edges, turn the right side out. `actions` (may be null) receives what was done,
// one sentence each. Throws std::runtime_error naming what is left if the result still bounds no solid.
TriangleMesh repair_mesh(TriangleMesh const& mesh, std::vector<std::string>* actions = nullptr, int largest_hole = 30);

}  // namespace scree
