// surface_samples.h: points of phi = 0 with normals, by surface projection: the step from phi to a point cloud.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/phi_batch.h"
#include "shapes/point_files.h"
#include "shapes/projection.h"
#include "shapes/zero_set.h"

namespace scree {

enum class SampleSpread {
  area,       // even over the surface: points of the marched zero set, moved onto phi = 0 by Algorithm 1
  directions  // evenly spread directions from the origin, Algorithm 2: for star-shaped bodies
};

struct SurfaceSamples {
  PointCloud cloud;  // outward normals; points whose projection failed are left out [d]
  ProjectionSummary projection;
};

// `domain`: the ball that holds the surface (and how finely it is marched). Deterministic. Throws std::invalid_argument
// when `directions` is asked of a body that is not star-shaped about the origin, std::runtime_error without a surface.
SurfaceSamples sample_surface(PhiBatch const& phi, ZeroSetOptions const& domain, int count, SampleSpread spread);

// Every ray from the origin meets the surface once, as far as 1,000 rays show.
bool is_star_shaped(PhiBatch const& phi, double radius);

}  // namespace scree
