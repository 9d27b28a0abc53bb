// surface_samples.cpp: see surface_samples.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/surface_samples.h"

#include <stdexcept>

#include "shapes/mesh_samples.h"
#include "shapes/star_radii.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

int constexpr star_rays = 1000;

}  // namespace

bool is_star_shaped(PhiBatch const& phi, double radius) {
  return !star_radii(phi, quasi_uniform_directions(star_rays), radius).empty();
}

SurfaceSamples sample_surface(PhiBatch const& phi, ZeroSetOptions const& domain, int count, SampleSpread spread) {
  ProjectionOptions options;
  options.radius = domain.radius;
  std::vector<Vec3> query;
  if (spread == SampleSpread::area) {
    query = sample_mesh(refine(phi, find_zero_set(phi, domain)).mesh, count).position;
  } else {
    if (!is_star_shaped(phi, domain.radius))
      throw std::invalid_argument("the body is not star-shaped about its centre: some ray meets its surface twice");
    options.method = ProjectionMethod::ray;
    query = quasi_uniform_directions(count);
    for (Vec3& q : query) q *= 0.5 * domain.radius;  // about the surface of a round grain
  }
  Projection const projection = project(phi, query, options);
  SurfaceSamples samples;
  samples.projection = summary(projection);
  for (int i = 0; i < count; ++i)
    if (projection.converged(i)) samples.cloud.position.push_back(projection.position[i]);
  std::vector<double> value(samples.cloud.position.size());
  samples.cloud.normal.resize(value.size());
  phi(samples.cloud.position, value, samples.cloud.normal);
  for (Vec3& n : samples.cloud.normal) {
    double const slope = norm(n);
    n = slope > 0 ? n * (-1 / slope) : Vec3{};
  }
  return samples;
}

}  // namespace scree
