// network_frame.h: from a body's frame to its network's and back, and what holds beyond the network's ball.
// One text for the CPU's functors and the fused device kernel, so that both give the same bits.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/views.h"

namespace scree {

// phi from outside the bounding sphere: a bound, not a distance. With cohesion, which pulls on nodes outside, it has to
// be continuous: then it is phi on the sphere at the same ray, less the distance to the sphere.
SCREE_HD inline double phi_outside_ball(double distance_to_centre, double radius) {
  return radius - distance_to_centre;
}

// The point of the ball on the same ray, or the point itself inside.
SCREE_HD inline Vec3 point_in_ball(Vec3 x, double radius) {
  double const r2 = norm2(x);
  return r2 > radius * radius ? x * (radius / std::sqrt(r2)) : x;
}

// Continues phi beyond the ball, from its value and gradient at the point on the ball.
SCREE_HD inline void continue_outside(Vec3 x, double radius, double& phi, Vec3* gradient) {
  double const r = norm(x);
  Vec3 const along = x / r;
  phi += phi_outside_ball(r, radius);
  if (gradient) *gradient = (*gradient - along * dot(along, *gradient)) * (radius / r) - along;
}

// What of a ShapeRecord a query of its network needs.
struct NetworkFrame {
  Mat3 rotation;  // x_network = rotation * (x * scale) + shift
  Vec3 shift;
  double scale = 1;
  double bounding_radius = 0.5;  // [d]
  int bias_row = 0;
};
SCREE_HD inline NetworkFrame network_frame(ShapeRecord const& s) {
  return {s.query_rotation, s.query_shift, s.query_scale, s.bounding_radius, s.bias_row};
}

// x [d, body frame] in the network's frame. A point beyond the ball is answered without the network (with cohesion:
// from the ball); the ball's centre then keeps the evaluator's input tame.
SCREE_HD inline Vec3f to_network(NetworkFrame const& f, double cohesion_reach, Vec3 x) {
  Vec3 y = norm2(x) <= f.bounding_radius * f.bounding_radius ? x : Vec3{};
  if (cohesion_reach > 0) y = point_in_ball(x, f.bounding_radius);
  return to_float(f.rotation * (y * f.scale) + f.shift);
}

// phi [d] and, unless null, its gradient in the body frame, from what the network said of to_network(x).
SCREE_HD inline void from_network(NetworkFrame const& f, double cohesion_reach, Vec3 x, float net_phi,
                                  Vec3f const* net_gradient, double& phi, Vec3* gradient) {
  double const r2 = norm2(x);
  bool const outside = r2 > f.bounding_radius * f.bounding_radius;
  phi = outside ? phi_outside_ball(std::sqrt(r2), f.bounding_radius) : net_phi / f.scale;
  if (net_gradient) *gradient = transposed_times(f.rotation, to_double(*net_gradient));
  if (!(outside && cohesion_reach > 0)) return;
  phi = net_phi / f.scale;
  continue_outside(x, f.bounding_radius, phi, net_gradient ? gradient : nullptr);
}

}  // namespace scree
