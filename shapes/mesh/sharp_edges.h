// sharp_edges.h: distance of points from the edges at which a mesh turns sharply.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "kernels/base/vec.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// Edges of a closed manifold mesh at which the outward normal turns by more than `angle` [rad], convex or concave.
std::vector<std::array<Vec3, 2>> sharp_edges(TriangleMesh const& mesh, double angle);

// Distance to the nearest of a set of segments by CGAL's AABB tree; infinite without segments.
class SegmentDistance {
 public:
  explicit SegmentDistance(std::vector<std::array<Vec3, 2>> const& segment);
  ~SegmentDistance();
  double operator()(Vec3 point) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;  // empty: no segments
};

}  // namespace scree
