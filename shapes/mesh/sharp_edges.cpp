// sharp_edges.cpp: distance of points from the edges at which a mesh turns sharply.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/sharp_edges.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>

#include <cmath>
#include <map>
#include <utility>

#include "shapes/mesh/cgal_mesh.h"

namespace scree {
namespace {

using Segment = cgal::Kernel::Segment_3;
using Segments = std::vector<Segment>;
using Primitive = CGAL::AABB_segment_primitive<cgal::Kernel, Segments::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<cgal::Kernel, Primitive>>;

}  // namespace

struct SegmentDistance::Data {
  Segments segment;
  Tree tree;
};

std::vector<std::array<Vec3, 2>> sharp_edges(TriangleMesh const& mesh, double angle) {
  std::map<std::pair<int, int>, Vec3> first;  // normal of the first triangle at each edge
  std::vector<std::array<Vec3, 2>> sharp;
  for (auto const& t : mesh.triangle) {
    Vec3 const area = cross(mesh.vertex[t[1]] - mesh.vertex[t[0]], mesh.vertex[t[2]] - mesh.vertex[t[0]]);
    Vec3 const normal = area / std::max(norm(area), 1e-300);
    for (int k = 0; k < 3; ++k) {
      int const a = t[k], b = t[(k + 1) % 3];
      auto const [at, fresh] = first.emplace(std::minmax(a, b), normal);
      if (!fresh && std::atan2(norm(cross(at->second, normal)), dot(at->second, normal)) > angle)
        sharp.push_back({mesh.vertex[a], mesh.vertex[b]});
    }
  }
  return sharp;
}

SegmentDistance::SegmentDistance(std::vector<std::array<Vec3, 2>> const& segment) {
  if (segment.empty()) return;
  data_ = std::make_unique<Data>();
  for (auto const& [a, b] : segment) data_->segment.emplace_back(cgal::to_point(a), cgal::to_point(b));
  data_->tree.insert(data_->segment.begin(), data_->segment.end());
  data_->tree.build();
  data_->tree.accelerate_distance_queries();
}

SegmentDistance::~SegmentDistance() = default;

double SegmentDistance::operator()(Vec3 point) const {
  if (!data_) return INFINITY;
  return std::sqrt(CGAL::to_double(data_->tree.squared_distance(cgal::to_point(point))));
}

}  // namespace scree
