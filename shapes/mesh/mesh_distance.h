// mesh_distance.h: exact signed distance to a closed triangle mesh, positive inside.
// CGAL's AABB tree gives the closest point, ray casting with exact predicates the sign: the truth networks learn from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"
#include "shapes/triangle_mesh.h"

namespace scree {

class MeshDistance {
 public:
  // Throws std::invalid_argument naming the first defect if the mesh is not closed, manifold and oriented outwards.
  explicit MeshDistance(TriangleMesh const& mesh);
  ~MeshDistance();
  MeshDistance(MeshDistance&&) noexcept;
  MeshDistance& operator=(MeshDistance&&) noexcept;

  struct Sample {
    double phi = 0;  // signed distance, positive inside [unit of the mesh]
    Vec3 closest;    // closest point of the surface [unit of the mesh]
    Vec3 gradient;   // of phi: unit length, pointing inwards; on the surface the triangle's inward normal
  };
  Sample at(Vec3 point) const;

  // The same for many points (n each; `gradient` may be empty), on `threads` OpenMP threads. The result does not depend
  // on the number of threads. 4 us a point and thread for 36 triangles, 30 to 40 us for 20,000.
  void evaluate(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient, int threads = 1) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace scree
