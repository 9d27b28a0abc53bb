// star_rays.h: the surface of a star-shaped body along rays from a point inside, and its mass from them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/direction_set.h"
#include "shapes/phi_batch.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// Rays origin + map (direction radius): `map` takes the unit ball to an ellipsoid like the body, in which frame the
// body is nearly a ball.
struct Rays {
  Vec3 origin;
  Mat3 map;

  Vec3 at(Vec3 direction, double radius) const { return origin + map * (direction * radius); }
};

enum class GrainFault {
  none,
  no_surface,       // phi is not positive at the origin of the rays, or the body has no volume
  outside_ball,     // the surface leaves the ball in which phi means something
  not_star_shaped,  // a ray meets the surface more than once: use make_surface_nodes
};
char const* to_string(GrainFault fault);

// radius[i]: where ray i leaves the body, found by Algorithm 2 (projection.h) for all rays at once; |phi| there is
// below 3e-6. `guess`: of all radii; `ball`: phi is never evaluated beyond this distance from x = 0. Deterministic.
GrainFault find_radii(PhiBatch const& phi, Rays const& rays, std::vector<Vec3> const& direction, double guess,
                      double ball, std::vector<double>& radius);

// Whether each ray leaves the body once: the radii of neighbours are continuous, and phi has the right sign at three
// places of each ray (three others for every second ray) between the origin and the sphere of `reach` about it.
// A sample, not a proof: a part narrower than the gaps between neighbouring rays' places can pass.
bool looks_star_shaped(PhiBatch const& phi, Rays const& rays, DirectionSet const& set,
                       std::vector<double> const& radius, double reach);

// Volume, centroid and inertia by quadrature over the cells of the directions, whose first-order errors cancel on
// centroidal cells. Area: see star_area.
MeshMass star_mass(Rays const& rays, DirectionSet const& set, std::vector<double> const& radius);

// Surface area by the same quadrature, with the normals of phi; 0 when a ray meets the surface at less than 5 degrees.
double star_area(PhiBatch const& phi, Rays const& rays, DirectionSet const& set, std::vector<double> const& radius);

}  // namespace scree
