// truth.h: the signed distance that networks are trained on and measured against.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"
#include "kernels/sdf/analytic.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// True Euclidean signed distance of a body, positive inside.
class Truth {
 public:
  virtual ~Truth() = default;
  // phi [d] and, unless `gradient` is empty, its unit gradient at n points, on `threads` OpenMP threads; the result
  // does not depend on their number.
  virtual void evaluate(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient, int threads = 1) const = 0;
};

// Exact distance to a closed triangle mesh (CGAL). Throws std::invalid_argument naming the mesh's first defect.
std::shared_ptr<Truth const> mesh_truth(TriangleMesh const& mesh);

// The formula's own distance, in double.
std::shared_ptr<Truth const> analytic_truth(AnalyticSdf const& shape);

}  // namespace scree
