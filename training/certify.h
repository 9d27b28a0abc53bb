// certify.h: errors of a normalised network shape against the mesh it was trained on.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "kernels/base/vec.h"
#include "shapes/phi_batch.h"
#include "shapes/shape.h"
#include "training/dataset.h"

namespace scree {

// The body's mesh lies elsewhere than the normalised shape: x_body = rotation^T x * scale + shift.
struct BodyFrame {
  Mat3 rotation;
  Vec3 shift;
  double scale = 1;

  Vec3 to_body(Vec3 x) const { return transposed_times(rotation, x) * scale + shift; }
  Vec3 to_shape(Vec3 x_body) const { return rotation * ((x_body - shift) / scale); }
};

// What a certificate has no field for.
struct InteriorReport {
  double deepest_phi = 0;    // largest phi over the interior points [d]
  double lowest_phi = 0;     // smallest phi where the truth is deeper than 0.05 d [d]; not positive: a void
  double share_falling = 0;  // of those points, those at which phi falls along the true inward direction
};

// Fill in mae, p99, max (the paper's shell), band_mae and the percentiles of |grad phi| (points offset from the surface
// by up to 0.05 d, both sides), the normals' errors (points of the body's surface) and hausdorff (vertices of phi's
// zero set against the mesh, and |phi| at points of the mesh). `points` of each kind; deterministic in `seed`.
InteriorReport certify(PhiBatch const& phi, Body const& body, BodyFrame const& frame, int points, std::uint64_t seed,
                       int threads, Certificate& certificate);

}  // namespace scree
