// certify.cpp: errors of a normalised network shape against the body it should be.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/certify.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "shapes/certify_phi.h"
#include "shapes/mesh/sharp_edges.h"
#include "shapes/random.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

double constexpr edge_angle = std::numbers::pi / 6;  // an edge sharper than this ...
double constexpr edge_reach = 0.03;                  // ... spoils the normals this near to it [d]

double mean(std::vector<double> const& values) {
  double sum = 0;
  for (double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

struct Sampled {
  std::vector<double> phi;     // [unit of the body]
  std::vector<Vec3> gradient;  // in the body's frame
};

// The shape's phi at points of the body's frame.
Sampled sample_shape(PhiBatch const& phi, BodyFrame const& frame, std::vector<Vec3> const& point_body, bool gradient) {
  std::vector<Vec3> point;
  for (Vec3 const& x : point_body) point.push_back(frame.to_shape(x));
  Sampled result{std::vector<double>(point.size()), std::vector<Vec3>(gradient ? point.size() : 0)};
  phi(point, result.phi, result.gradient);
  for (double& value : result.phi) value *= frame.scale;
  for (Vec3& g : result.gradient) g = transposed_times(frame.rotation, g);
  return result;
}

Sampled sample_truth(CertifyTruth const& truth, std::vector<Vec3> const& point) {
  Sampled result{std::vector<double>(point.size()), std::vector<Vec3>(point.size())};
  truth.distance(point, result.phi, result.gradient);
  return result;
}

struct Errors {
  double mean, p99, max;  // [d]
};
Errors errors(PhiBatch const& phi, CertifyTruth const& truth, BodyFrame const& frame, std::vector<Vec3> const& point) {
  std::vector<double> const net = sample_shape(phi, frame, point, false).phi, exact = sample_truth(truth, point).phi;
  std::vector<double> error;
  for (std::size_t i = 0; i < point.size(); ++i) error.push_back(std::abs(net[i] - exact[i]) / frame.scale);
  return {mean(error), percentile(error, 0.99), *std::max_element(error.begin(), error.end())};
}

std::vector<Vec3> shell_points(CertifyTruth const& truth, int count, std::uint64_t seed) {
  Random random(seed);
  double const low = std::pow(0.9 * truth.inscribed_radius, 3), high = std::pow(1.1 * truth.bounding_radius, 3);
  std::vector<Vec3> point;
  for (int i = 0; i < count; ++i) {
    double const radius = std::cbrt(random.uniform(low, high));
    point.push_back(random.direction() * radius);
  }
  return point;
}

SurfacePoints points_on(CertifyTruth const& truth, int count) {
  SurfacePoints surface = surface_points(*truth.mesh, count);
  if (truth.exact_mesh) return surface;
  Sampled const at = sample_truth(truth, surface.position);  // from the chords onto the surface
  for (std::size_t i = 0; i < at.phi.size(); ++i) {
    surface.position[i] -= at.gradient[i] * at.phi[i];
    surface.normal[i] = surface.interpolated[i] = -at.gradient[i];
  }
  return surface;
}

// Which points of the surface lie far from sharp edges.
std::vector<char> flat_points(CertifyTruth const& truth, BodyFrame const& frame, std::vector<Vec3> const& point) {
  SegmentDistance const edge_distance(sharp_edges(*truth.mesh, edge_angle));
  std::vector<char> flat;
  for (Vec3 const& x : point) flat.push_back(edge_distance(x) > edge_reach * frame.scale);
  return flat;
}

// `sense`: -1 where one of the two points outwards and the other inwards.
NormalAngles angles_between(std::vector<Vec3> const& a, std::vector<Vec3> const& b, double sense,
                            std::vector<char> const& flat) {
  std::vector<double> angle, flat_angle;
  for (std::size_t i = 0; i < a.size(); ++i) {
    angle.push_back(std::atan2(norm(cross(a[i], b[i])), sense * dot(a[i], b[i])) * 180 / std::numbers::pi);
    if (flat[i]) flat_angle.push_back(angle.back());
  }
  return {percentile(angle, 0.5), percentile(angle, 0.95), percentile(flat_angle, 0.95)};
}

NormalComparison compare(Sampled const& on, SurfacePoints const& surface, std::vector<char> const& flat) {
  NormalComparison result;
  result.to_triangles = angles_between(on.gradient, surface.normal, -1, flat);
  result.to_interpolated = angles_between(on.gradient, surface.interpolated, -1, flat);
  result.triangles_to_interpolated = angles_between(surface.normal, surface.interpolated, 1, flat);
  result.flat_share = static_cast<double>(std::count(flat.begin(), flat.end(), 1)) / static_cast<double>(flat.size());
  return result;
}

void certify_surface(PhiBatch const& phi, CertifyTruth const& truth, BodyFrame const& frame,
                     SurfacePoints const& surface, Certificate& certificate) {
  Sampled const on = sample_shape(phi, frame, surface.position, true);
  for (double value : on.phi) certificate.hausdorff = std::max(certificate.hausdorff, std::abs(value) / frame.scale);
  NormalComparison const normals = compare(on, surface, flat_points(truth, frame, surface.position));
  certificate.normal_p50 = normals.to_triangles.p50;
  certificate.normal_p95 = normals.to_triangles.p95;
  certificate.flat_normal_p95 = normals.to_triangles.flat_p95;
  certificate.flat_share = normals.flat_share;
}

// Farthest vertex of phi's zero set from the body.
double zero_set_to_body(PhiBatch const& phi, CertifyTruth const& truth, BodyFrame const& frame) {
  ZeroSetOptions options;
  options.radius = 1.1 * truth.bounding_radius / frame.scale;
  std::vector<Vec3> vertex = find_zero_set(phi, options).mesh.vertex;
  for (Vec3& v : vertex) v = frame.to_body(v);
  double farthest = 0;
  for (double d : sample_truth(truth, vertex).phi) farthest = std::max(farthest, std::abs(d) / frame.scale);
  return farthest;
}

}  // namespace

CertifyTruth truth_of(TriangleMesh const& mesh, PhiBatch distance) {
  CertifyTruth truth{std::move(distance), &mesh};
  Vec3 const centre;
  double phi = 0;
  truth.distance({&centre, 1}, {&phi, 1}, {});
  truth.inscribed_radius = std::max(phi, 0.0);
  for (Vec3 const& v : mesh.vertex) truth.bounding_radius = std::max(truth.bounding_radius, norm(v));
  return truth;
}

NormalComparison compare_normals(PhiBatch const& phi, CertifyTruth const& truth, BodyFrame const& frame, int points) {
  SurfacePoints const surface = points_on(truth, points);
  return compare(sample_shape(phi, frame, surface.position, true), surface,
                 flat_points(truth, frame, surface.position));
}

void certify(PhiBatch const& phi, CertifyTruth const& truth, BodyFrame const& frame, int points, std::uint64_t seed,
             Certificate& certificate) {
  Errors const shell = errors(phi, truth, frame, shell_points(truth, points, seed));
  certificate.mae = shell.mean, certificate.p99 = shell.p99, certificate.max = shell.max;

  SurfacePoints surface = points_on(truth, points);
  certificate.hausdorff = zero_set_to_body(phi, truth, frame);
  certify_surface(phi, truth, frame, surface, certificate);

  Random random(seed + 1);
  for (std::size_t i = 0; i < surface.position.size(); ++i)
    surface.position[i] += surface.normal[i] * (frame.scale * random.uniform(-contact_band, contact_band));
  Errors const band = errors(phi, truth, frame, surface.position);
  certificate.band_mae = band.mean, certificate.band_p99 = band.p99, certificate.band_max = band.max;
}

}  // namespace scree
