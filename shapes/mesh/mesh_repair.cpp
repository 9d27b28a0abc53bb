// mesh_repair.cpp: the simple repairs by CGAL: weld, orient, stitch, keep the largest part, fill small holes.
// SPDX-License-Identifier: Apache-2.0
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <cmath>
#include <stdexcept>

#include "shapes/mesh/cgal_mesh.h"
#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh_files.h"

namespace scree {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

// A manifold, consistently oriented mesh from any soup; edges that cannot be manifold are cut open.
cgal::Mesh oriented_mesh(TriangleMesh const& soup, std::vector<std::string>& actions) {
  std::vector<cgal::Point> points;
  for (Vec3 const& v : soup.vertex) points.push_back(cgal::to_point(v));
  std::vector<std::vector<std::size_t>> polygons;
  for (auto const& [a, b, c] : soup.triangle)
    polygons.push_back({static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c)});
  std::size_t const before = polygons.size();
  pmp::repair_polygon_soup(points, polygons);
  if (polygons.size() != before)
    actions.push_back("dropped " + std::to_string(before - polygons.size()) + " degenerate or duplicate triangles");
  if (!pmp::orient_polygon_soup(points, polygons)) actions.push_back("cut the surface open at non-manifold places");
  cgal::Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  if (auto const stitched = pmp::stitch_borders(mesh); stitched > 0)
    actions.push_back("stitched " + std::to_string(stitched) + " pairs of edges");
  pmp::remove_degenerate_faces(mesh);
  mesh.collect_garbage();
  return mesh;
}

void keep_largest(cgal::Mesh& mesh, std::vector<std::string>& actions) {
  std::size_t const removed = pmp::keep_largest_connected_components(mesh, 1);
  mesh.collect_garbage();
  if (removed > 0) actions.push_back("removed " + std::to_string(removed) + " smaller parts");
}

void fill_holes(cgal::Mesh& mesh, int largest_hole, std::vector<std::string>& actions) {
  std::vector<cgal::Mesh::Halfedge_index> cycles;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(cycles));
  for (auto const start : cycles) {
    int length = 0;
    for (auto h = start; length == 0 || h != start; h = mesh.next(h)) ++length;
    if (length > largest_hole) continue;
    std::vector<cgal::Mesh::Face_index> patch;
    pmp::triangulate_hole(mesh, start, std::back_inserter(patch));
    actions.push_back("filled a hole of " + std::to_string(length) + " edges with " + std::to_string(patch.size()) +
                      " triangles");
  }
}

}  // namespace

TriangleMesh repair_mesh(TriangleMesh const& input, std::vector<std::string>* actions_out, int largest_hole) {
  std::vector<std::string> actions;
  TriangleMesh const welded = weld(input);
  if (welded.vertex.size() != input.vertex.size())
    actions.push_back("welded " + std::to_string(input.vertex.size()) + " corners to " +
                      std::to_string(welded.vertex.size()) + " vertices");
  if (welded.triangle.empty()) throw std::runtime_error("the mesh has no triangles: is it the right file?");
  cgal::Mesh mesh = oriented_mesh(welded, actions);
  keep_largest(mesh, actions);
  fill_holes(mesh, largest_hole, actions);
  if (CGAL::is_closed(mesh) && !pmp::is_outward_oriented(mesh)) {
    pmp::reverse_face_orientations(mesh);
    actions.push_back("turned the mesh right side out");
  }
  TriangleMesh const result = cgal::from_cgal(mesh);
  MeshReport const report = check_mesh(result);
  if (!report.defects.empty()) {
    std::string const& left = report.defects.front();
    throw std::runtime_error("cannot be repaired: " + left.substr(0, left.rfind(" (scree-shape")) +
                             (report.open_edges > 0 ? "; holes of more than " + std::to_string(largest_hole) +
                                                          " edges stay open unless scree-shape import "
                                                          "--largest-hole is raised"
                                                    : ""));
  }
  if (actions_out) *actions_out = actions;
  return result;
}

}  // namespace scree
