// certify.h: errors of a normalised network shape against the body it should be.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernels/base/vec.h"
#include "shapes/phi_batch.h"
#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// The body lies elsewhere than the normalised shape: x_body = rotation^T x * scale + shift.
struct BodyFrame {
  Mat3 rotation;
  Vec3 shift;
  double scale = 1;

  Vec3 to_body(Vec3 x) const { return transposed_times(rotation, x) * scale + shift; }
  Vec3 to_shape(Vec3 x_body) const { return rotation * ((x_body - shift) / scale); }
};

// What a shape is measured against, in the body's frame.
struct CertifyTruth {
  PhiBatch distance;              // true signed distance, positive inside, with its unit gradient
  TriangleMesh const* mesh = {};  // closed, its vertices on the surface
  bool exact_mesh = true;         // `mesh` is the truth itself, not a triangulation of it
  double inscribed_radius = 0;    // distance of the origin from the surface; 0 if it lies outside
  double bounding_radius = 0;     // of the surface about the origin
};
CertifyTruth truth_of(TriangleMesh const& mesh, PhiBatch distance);

// Angles between normals at points of the surface: percentiles over all, and over those farther than 0.03 d from edges
// that turn by more than 30 degrees [degrees].
struct NormalAngles {
  double p50 = -1, p95 = -1, flat_p95 = -1;
};
// grad phi against the triangles' normals, the yardstick of certificates, and against normals interpolated over the
// mesh; and the triangles against the interpolated ones. The last is what the mesh itself leaves open: a scan's
// triangles turn to and fro about the surface they sample, and a smooth phi cannot follow them.
struct NormalComparison {
  NormalAngles to_triangles, to_interpolated, triangles_to_interpolated;
  double flat_share = -1;  // of the surface
};
// Deterministic.
NormalComparison compare_normals(PhiBatch const& phi, CertifyTruth const& truth, BodyFrame const& frame, int points);

// Fill in the entries of `certificate` that need the truth, volume and inertia errors excepted: mae, p99, max (the
// paper's shell, uniform in volume between 0.9 inscribed and 1.1 bounding radius), the same for the band (points of the
// surface moved along its normal by up to contact_band), the normals' errors (points of the surface), hausdorff
// (vertices of phi's zero set against the body, and |phi| at points of the body). `points` of each kind; deterministic
// in `seed`. Throws std::runtime_error when phi has no zero set.
void certify(PhiBatch const& phi, CertifyTruth const& truth, BodyFrame const& frame, int points, std::uint64_t seed,
             Certificate& certificate);

}  // namespace scree
