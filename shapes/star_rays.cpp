// star_rays.cpp: see star_rays.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/star_rays.h"

#include <algorithm>
#include <cmath>

#include "shapes/projection.h"

namespace scree {
namespace {

double constexpr phi_small = 3e-6;  // ten roundings of a float phi, below half a step of the 16-bit radii

double determinant(Mat3 const& m) { return dot(m.row[0], cross(m.row[1], m.row[2])); }

}  // namespace

char const* to_string(GrainFault fault) {
  switch (fault) {
    case GrainFault::none:
      return "none";
    case GrainFault::no_surface:
      return "no surface around its centre";
    case GrainFault::outside_ball:
      return "reaches out of the ball its network was trained in";
    case GrainFault::not_star_shaped:
      return "not star-shaped";
  }
  return "unknown";
}

GrainFault find_radii(PhiBatch const& phi, Rays const& rays, std::vector<Vec3> const& direction, double guess,
                      double ball, std::vector<double>& radius) {
  double const room = ball - norm(rays.origin);
  double at_origin = 0;
  if (room > 0) phi(Span<const Vec3>(&rays.origin, 1), Span<double>(&at_origin, 1), {});
  if (!(at_origin > 0)) return GrainFault::no_surface;
  PhiBatch const about_origin = [&](Span<const Vec3> point, Span<double> value, Span<Vec3> gradient) {
    std::vector<Vec3> x(point.begin(), point.end());
    for (Vec3& p : x) p += rays.origin;
    phi(x, value, gradient);
  };
  std::vector<Vec3> start;
  for (Vec3 u : direction) start.push_back(rays.map * (u * guess));
  Projection const hit =
      project(about_origin, start, {.method = ProjectionMethod::ray, .tolerance = phi_small, .radius = room});
  radius.resize(direction.size());
  for (std::size_t i = 0; i < direction.size(); ++i) {
    if (hit.outcome[i] == ProjectionOutcome::no_surface) return GrainFault::outside_ball;  // phi > 0 at the origin
    if (!hit.converged(static_cast<int>(i))) return GrainFault::not_star_shaped;
    radius[i] = guess * norm(hit.position[i]) / norm(start[i]);
  }
  return GrainFault::none;
}

bool looks_star_shaped(PhiBatch const& phi, Rays const& rays, DirectionSet const& set,
                       std::vector<double> const& radius, double reach) {
  double constexpr steepest = 6;  // of the logarithmic radius: the ray meets the surface at less than 10 degrees
  double constexpr inside[2][2] = {{0.35, 0.8}, {0.6, 0.92}}, outside[2] = {0.3, 0.7};
  for (int i = 0; i < set.count(); ++i)
    for (int k = set.ring_first[i]; k < set.ring_first[i + 1]; ++k) {
      int const j = set.neighbour[k];
      double const rise = std::abs(std::log(radius[i] / radius[j]));
      if (rise > steepest * norm(set.direction[i] - set.direction[j])) return false;
    }
  std::vector<Vec3> point;
  for (int i = 0; i < set.count(); ++i) {
    double const length = norm(rays.map * set.direction[i]);
    double const far = std::max(radius[i], reach / length);
    for (double share : inside[i % 2]) point.push_back(rays.at(set.direction[i], share * radius[i]));
    point.push_back(rays.at(set.direction[i], radius[i] + outside[i % 2] * (far - radius[i])));
  }
  std::vector<double> value(point.size());
  phi(point, value, {});
  for (std::size_t k = 0; k < point.size(); ++k) {
    bool const beyond = k % 3 == 2;
    if (beyond ? value[k] > 1e-4 : !(value[k] > 0)) return false;
  }
  return true;
}

MeshMass star_mass(Rays const& rays, DirectionSet const& set, std::vector<double> const& radius) {
  double volume = 0, second[3][3] = {};
  Vec3 first;
  for (int i = 0; i < set.count(); ++i) {
    Vec3 const u = set.direction[i];
    double const r = radius[i], w = set.solid_angle[i] * r * r * r;
    volume += w / 3;
    first += u * (w * r / 4);
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b) second[a][b] += w * r * r / 5 * u[a] * u[b];
  }
  MeshMass mass;
  double const det = std::abs(determinant(rays.map));
  mass.volume = det * volume;
  if (!(volume > 0)) return mass;
  Vec3 const c = first / volume;
  mass.centroid = rays.at(c, 1);
  Mat3 central;  // second moments about the centroid in the frame of the rays
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) central.row[a][b] = central.row[b][a] = second[a][b] - volume * c[a] * c[b];
  Mat3 const moments = rays.map * central * transpose(rays.map);
  double const trace = moments.row[0].x + moments.row[1].y + moments.row[2].z;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) mass.inertia.row[a][b] = det * ((a == b ? trace : 0) - moments.row[a][b]);
  return mass;
}

double star_area(PhiBatch const& phi, Rays const& rays, DirectionSet const& set, std::vector<double> const& radius) {
  double constexpr least_sine = 0.087;
  double const det = std::abs(determinant(rays.map));
  std::vector<Vec3> point(set.count()), gradient(set.count());
  std::vector<double> value(set.count());
  for (int i = 0; i < set.count(); ++i) point[i] = rays.at(set.direction[i], radius[i]);
  phi(point, value, gradient);
  double area = 0;
  for (int i = 0; i < set.count(); ++i) {
    Vec3 const arm = point[i] - rays.origin;
    double const height = -dot(arm, gradient[i]) / norm(gradient[i]);  // of the tangent plane over the origin
    if (!(height > least_sine * norm(arm))) return 0;
    area += set.solid_angle[i] * det * radius[i] * radius[i] * radius[i] / height;  // three times the cone's volume
  }
  return area;
}

}  // namespace scree
