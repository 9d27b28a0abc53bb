// mesh_report.cpp: see mesh_report.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
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

// " (one at (0.1, 0.2, 0.3))": where to look.
std::string place(Vec3 where) {
  char text[96];
  std::snprintf(text, sizeof(text), " (one at (%.4g, %.4g, %.4g))", where.x, where.y, where.z);
  return text;
}

// Where the first edge of each defect lies: its middle [unit].
struct Places {
  Vec3 open, non_manifold, misoriented, small_part;
};

void add_defects(MeshReport& report, Places const& at, double area) {
  auto const say = [&](std::string text) { report.defects.push_back(std::move(text)); };
  if (report.triangles == 0) say("the mesh has no triangles: is it the right file?");
  if (report.degenerate_triangles > 0)
    say(std::to_string(report.degenerate_triangles) + " triangles have no area: drop them (scree-shape import)");
  if (report.open_edges > 0)
    say("the surface is open along " + std::to_string(report.open_edges) + " edges" + place(at.open) +
        ", so it has no inside: close it (scree-shape import fills small holes)");
  if (report.non_manifold_edges > 0)
    say(std::to_string(report.non_manifold_edges) + " edges" + place(at.non_manifold) +
        " belong to three or more triangles, so the mesh is non-manifold: separate the sheets that touch (scree-shape "
        "import tries)");
  if (report.misoriented_edges > 0)
    say("neighbouring triangles face opposite ways at " + std::to_string(report.misoriented_edges) + " edges" +
        place(at.misoriented) + ": orient them (scree-shape import)");
  if (report.components > 1)
    say("the mesh has " + std::to_string(report.components) + " separate parts" + place(at.small_part) +
        ": keep one (scree-shape import keeps the largest)");
  if (!report.defects.empty()) return;
  // A folded sheet is closed, but its volume is rounding: a sphere has 0.094 of this measure, a coin of 1:1000 4e-4.
  if (std::abs(report.volume) <= 1e-9 * std::pow(area, 1.5))
    say("the mesh encloses no volume: it is a sheet, give it a thickness");
  else if (report.volume < 0)
    say("the mesh is inside out: turn it over (scree-shape import)");
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
  Places at;
  std::map<int, int> part_size;  // by root
  for (int t = 0; t < report.triangles; ++t) ++part_size[find_root(parent, t)];
  report.components = static_cast<int>(part_size.size());
  if (!part_size.empty()) {
    auto const smaller = [](auto const& a, auto const& b) { return a.second < b.second; };
    auto const smallest = std::min_element(part_size.begin(), part_size.end(), smaller);
    at.small_part = mesh.vertex[mesh.triangle[smallest->first][0]];
  }
  for (auto const& [edge, use] : edges) {
    int const n = use.forward + use.backward;
    Vec3 const middle = (mesh.vertex[edge.first] + mesh.vertex[edge.second]) * 0.5;
    if (n == 1 && ++report.open_edges == 1) at.open = middle;
    if (n > 2 && ++report.non_manifold_edges == 1) at.non_manifold = middle;
    if (n == 2 && use.forward != 1 && ++report.misoriented_edges == 1) at.misoriented = middle;
  }
  MeshMass const mass = mesh_mass(mesh);
  report.volume = mass.volume;
  add_defects(report, at, mass.area);
  return report;
}

}  // namespace scree
