// mesh_check.cpp: what keeps a triangle mesh from bounding one solid.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/mesh_check.h"

#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include "shapes/mesh/cgal_mesh.h"
#include "shapes/mesh_files.h"

namespace scree {

MeshReport check_mesh(TriangleMesh const& mesh, bool intersections) {
  MeshReport report = report_mesh(mesh);
  if (intersections && report.defects.empty()) {
    report.self_intersecting = CGAL::Polygon_mesh_processing::does_self_intersect(cgal::to_cgal(weld(mesh)));
    if (report.self_intersecting)
      report.defects.push_back("the surface cuts through itself: remesh it (for instance with a small closing offset)");
  }
  return report;
}

}  // namespace scree
