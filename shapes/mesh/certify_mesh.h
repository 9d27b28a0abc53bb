// certify_mesh.h: a shape of a library against a mesh that lies anywhere, in any unit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "shapes/mesh/align.h"
#include "shapes/mesh/mesh_distance.h"

namespace scree {

// The mesh as the truth of a shape, its centroid moved to the origin.
class MeshTruth {
 public:
  // Throws std::invalid_argument naming the first defect of a mesh that bounds no solid.
  MeshTruth(TriangleMesh mesh, Library const& library, Shape const& shape, int threads);

  TriangleMesh const& mesh() const { return mesh_; }
  Alignment const& alignment() const { return alignment_; }
  CertifyTruth truth() const;

  // All entries of `certificate` that need a truth, measured with `points` of each kind. Volume and inertia errors: the
  // shape, in the size that fits the mesh's surface best, against the mesh; what a training certifies is the network as
  // trained, before normalisation, which no file tells. Deterministic. Throws as certify().
  void certify(PhiBatch const& phi, Shape const& shape, int points, std::uint64_t seed, Certificate& certificate) const;

  // What the normals' errors are made of.
  NormalComparison compare_normals(PhiBatch const& phi, int points) const;

 private:
  TriangleMesh mesh_;
  std::shared_ptr<MeshDistance const> distance_;
  Alignment alignment_;
  int threads_ = 1;
};

}  // namespace scree
