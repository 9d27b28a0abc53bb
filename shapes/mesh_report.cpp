// mesh_report.cpp: see mesh_report.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_report.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "shapes/mesh_files.h"

namespace scree {
namespace {

struct EdgeUse {
  int forward = 0, backward = 0;  // triangles that run through it from the smaller to the larger vertex, and back
  int triangle = -1;              // one of them
};

bool is_degenerate(TriangleMesh const& mesh, std::array<int, 3> const& t) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  Vec3 const a = mesh.vertex[t[1]] - mesh.vertex[t[0]];
  Vec3 const b = mesh.vertex[t[2]] - mesh.vertex[t[0]];
  return norm2(cross(a, b)) <= 1e-24 * norm2(a) * norm2(b);  // an angle below 1e-12: rounding of the file's digits
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

void add_defects(MeshReport& report) {
  auto const say = [&](std::string text) { report.defects.push_back(std::move(text)); };
  if (report.triangles == 0) say("the mesh has no triangles: is it the right file?");
  if (report.degenerate_triangles > 0)
    say(std::to_string(report.degenerate_triangles) + " triangles have no area: drop them (scree-shape import)");
  if (report.open_edges > 0)
    say("the surface is open along " + std::to_string(report.open_edges) +
        " edges, so it has no inside: close it (scree-shape import fills small holes)");
  if (report.non_manifold_edges > 0)
    say(std::to_string(report.non_manifold_edges) +
        " edges belong to three or more triangles: separate the sheets that touch (scree-shape import tries)");
  if (report.misoriented_edges > 0)
    say("neighbouring triangles face opposite ways at " + std::to_string(report.misoriented_edges) +
        " edges: orient them (scree-shape import)");
  if (report.components > 1)
    say("the mesh has " + std::to_string(report.components) +
        " separate parts: keep one (scree-shape import keeps the largest)");
  if (report.defects.empty() && report.volume <= 0) say("the mesh is inside out: turn it over (scree-shape import)");
}

}  // namespace

MeshReport report_mesh(TriangleMesh const& input) {
  TriangleMesh const mesh = weld(input);
  MeshReport report;
  report.vertices = static_cast<int>(mesh.vertex.size());
  report.triangles = static_cast<int>(mesh.triangle.size());
  report.degenerate_triangles = static_cast<int>(input.triangle.size()) - report.triangles;  // dropped by weld
  std::map<std::pair<int, int>, EdgeUse> edges;
  std::vector<int> parent(mesh.triangle.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (int t = 0; t < report.triangles; ++t) {
    auto const& corner = mesh.triangle[t];
    report.degenerate_triangles += is_degenerate(mesh, corner);
    for (int k = 0; k < 3; ++k) {
      int const from = corner[k], to = corner[(k + 1) % 3];
      EdgeUse& use = edges[{std::min(from, to), std::max(from, to)}];
      ++(from < to ? use.forward : use.backward);
      if (use.triangle >= 0) parent[find_root(parent, t)] = find_root(parent, use.triangle);
      use.triangle = t;
    }
  }
  for (int t = 0; t < report.triangles; ++t) report.components += find_root(parent, t) == t;
  for (auto const& [edge, use] : edges) {
    int const n = use.forward + use.backward;
    report.open_edges += n == 1;
    report.non_manifold_edges += n > 2;
    report.misoriented_edges += n == 2 && use.forward != 1;
  }
  report.volume = mesh_mass(mesh).volume;
  add_defects(report);
  return report;
}

}  // namespace scree
