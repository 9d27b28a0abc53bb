// surface_sampler.h: random points on a triangle mesh, and beside its edges.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/random.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// Holds a reference: the mesh must outlive it.
class SurfaceSampler {
 public:
  // `curved`: also prepare draw_curved().
  explicit SurfaceSampler(TriangleMesh const& mesh, bool curved = false);

  struct Point {
    Vec3 position, outward;
  };
  // Uniform in area: triangle by area, then barycentric; its normal.
  Point draw(Random& random) const;

  // On an edge of the closed mesh chosen by length x angle between its faces' normals, twice its share of the integral
  // of mean curvature: on sharp edges of a polyhedron, and on a smooth body wherever it bends.
  Vec3 draw_curved(Random& random) const;

 private:
  TriangleMesh const& mesh_;
  std::vector<Vec3> outward_;
  std::vector<double> cumulative_;
  struct Edge {
    int a, b;
  };
  std::vector<Edge> edge_;
  std::vector<double> edge_cumulative_;
};

}  // namespace scree
