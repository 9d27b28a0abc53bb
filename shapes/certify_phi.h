// certify_phi.h: what a certificate can say about a shape without knowing what it should look like.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"

namespace scree {

struct CertifyPhiOptions {
  int points = 20000;  // of each measurement
  int nodes = 4000;    // surface nodes whose blind gap is measured; 0: left unmeasured
  int threads = 1;
};

// Fill in the entries of `certificate` that phi alone tells: percentiles of |grad phi| and `falling` (check_solid),
// gap, components and euler. The shape is a normalised one (uses its bounding radius). Deterministic, whatever the
// threads. About 0.5 s for a 6x64 network. Throws std::runtime_error without a zero set.
void certify_phi(Library const& library, Shape const& shape, CertifyPhiOptions const& options,
                 Certificate& certificate);

// Linear in rank between the two nearest values; -1 of nothing. `share` in 0..1.
double percentile(std::vector<double> values, double share);

// Points of the mesh's surface, uniform in area (low-discrepancy), with outward unit normals: those of their triangles,
// and those interpolated between the triangle's corners, where a corner's is the mean of the triangles around it
// weighted by their angles (Thuermer, Wuethrich 1998).
struct SurfacePoints {
  std::vector<Vec3> position, normal, interpolated;
};
SurfacePoints surface_points(TriangleMesh const& mesh, int count);

}  // namespace scree
