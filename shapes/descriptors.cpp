// descriptors.cpp: see descriptors.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/descriptors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "shapes/support_points.h"

namespace scree {
namespace {

// An octahedron whose triangles are cut in four `cuts` times, vertices on the unit sphere.
TriangleMesh direction_sphere(int cuts) {
  TriangleMesh sphere;
  sphere.vertex = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  sphere.triangle = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middle;
    auto const midpoint = [&](int a, int b) {
      auto const [at, fresh] = middle.try_emplace(std::minmax(a, b), static_cast<int>(sphere.vertex.size()));
      if (fresh) sphere.vertex.push_back(normalized(sphere.vertex[a] + sphere.vertex[b]));
      return at->second;
    };
    std::vector<std::array<int, 3>> fine;
    for (auto const& t : sphere.triangle) {
      int const a = midpoint(t[0], t[1]), b = midpoint(t[1], t[2]), c = midpoint(t[2], t[0]);
      fine.insert(fine.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    sphere.triangle = std::move(fine);
  }
  return sphere;
}

// Volume inside the extreme points of the directions, joined as their directions are: the directions map onto the hull
// once, so this is the volume of an inscribed polyhedron, with the flat faces of a polytope whole.
double hull_volume(std::vector<Vec3> const& point, int cuts) {
  TriangleMesh hull = direction_sphere(cuts);
  // Turned a little: directions that are exactly normal to a face have no single extreme point.
  Mat3 const turn = to_matrix(normalized(Quat{1, 0.0123, 0.0234, 0.0345}));
  for (Vec3& d : hull.vertex) d = turn * d;
  std::vector<int> const extreme = extreme_points(point, hull.vertex);
  for (std::size_t i = 0; i < extreme.size(); ++i) hull.vertex[i] = point[extreme[i]];
  return mesh_mass(hull).volume;
}

}  // namespace

Descriptors describe(TriangleMesh const& mesh) {
  MeshMass const mass = mesh_mass(mesh);
  if (!(mass.volume > 0)) throw std::invalid_argument("describe: the mesh encloses no volume");
  Descriptors d;
  d.sphericity = std::cbrt(std::numbers::pi * 36 * mass.volume * mass.volume) / mass.area;
  Vec3 low = mesh.vertex[0], high = low;
  for (Vec3 v : mesh.vertex)
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k]);
      high[k] = std::max(high[k], v[k]);
    }
  double extent[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
  std::sort(extent, extent + 3);
  d.elongation = extent[1] / extent[2];
  d.flatness = extent[0] / extent[1];
  double const coarse = hull_volume(mesh.vertex, 4), fine = hull_volume(mesh.vertex, 5);
  d.convexity = std::min(1.0, mass.volume / ((4 * fine - coarse) / 3));  // inscribed: second order in the angle
  return d;
}

}  // namespace scree
