// certify.cpp: errors of a normalised network shape against the mesh it was trained on.
// SPDX-License-Identifier: Apache-2.0
#include "training/certify.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shapes/random.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

double constexpr band_width = 0.05;  // the contact region, deeper overlaps stop a run [d]

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return -1;
  auto const at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double mean(std::vector<double> const& values) {
  double sum = 0;
  for (double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// phi and its gradient of the shape at points of the body's frame, both in the body's frame.
struct Evaluated {
  std::vector<double> phi;     // [unit of the body: d of the mesh]
  std::vector<Vec3> gradient;  // in the body's frame
};
Evaluated evaluate(PhiBatch const& phi, BodyFrame const& frame, std::vector<Vec3> const& point_body) {
  std::vector<Vec3> point;
  for (Vec3 const& x : point_body) point.push_back(frame.to_shape(x));
  Evaluated result{std::vector<double>(point.size()), std::vector<Vec3>(point.size())};
  phi(point, result.phi, result.gradient);
  for (double& value : result.phi) value *= frame.scale;
  for (Vec3& g : result.gradient) g = transposed_times(frame.rotation, g);
  return result;
}

std::vector<double> errors(Evaluated const& net, Samples const& truth, double scale) {
  std::vector<double> error;
  for (std::size_t i = 0; i < truth.phi.size(); ++i) error.push_back(std::abs(net.phi[i] - truth.phi[i]) / scale);
  return error;
}

void certify_surface(PhiBatch const& phi, Body const& body, BodyFrame const& frame, int points, std::uint64_t seed,
                     int threads, Certificate& certificate) {
  Samples samples = surface_samples(body, points, seed);
  Evaluated const on = evaluate(phi, frame, samples.point);
  std::vector<double> angle;
  for (std::size_t i = 0; i < on.gradient.size(); ++i) {
    double const sine = norm(cross(on.gradient[i], samples.gradient[i])),
                 cosine = dot(on.gradient[i], samples.gradient[i]);
    angle.push_back(std::atan2(sine, cosine) * 180 / std::numbers::pi);
    certificate.hausdorff = std::max(certificate.hausdorff, std::abs(on.phi[i]) / frame.scale);
  }
  certificate.normal_p50 = percentile(angle, 0.5);
  certificate.normal_p95 = percentile(angle, 0.95);

  Random random(seed + 1);
  for (std::size_t i = 0; i < samples.point.size(); ++i)
    samples.point[i] += samples.gradient[i] * random.uniform(-band_width, band_width);
  body.distance->evaluate(samples.point, samples.phi, samples.gradient, threads);
  Evaluated const near = evaluate(phi, frame, samples.point);
  certificate.band_mae = mean(errors(near, samples, frame.scale));
  std::vector<double> slope;
  for (Vec3 const& g : near.gradient) slope.push_back(norm(g));
  certificate.gradient_p1 = percentile(slope, 0.01);
  certificate.gradient_p5 = percentile(slope, 0.05);
  certificate.gradient_p95 = percentile(slope, 0.95);
  certificate.gradient_p99 = percentile(slope, 0.99);
}

InteriorReport examine_interior(PhiBatch const& phi, Body const& body, BodyFrame const& frame, int points,
                                std::uint64_t seed, int threads) {
  Random random(seed);
  Samples inside;
  for (int i = 0; i < points; ++i)
    inside.point.push_back(random.direction() * (body.bounding_radius * std::cbrt(random.uniform())));
  inside.phi.resize(inside.point.size());
  inside.gradient.resize(inside.point.size());
  body.distance->evaluate(inside.point, inside.phi, inside.gradient, threads);
  Evaluated const net = evaluate(phi, frame, inside.point);
  InteriorReport report{-1e300, 1e300, 0};
  int deep = 0;
  for (std::size_t i = 0; i < inside.point.size(); ++i) {
    if (inside.phi[i] < band_width) continue;
    ++deep;
    report.deepest_phi = std::max(report.deepest_phi, net.phi[i] / frame.scale);
    report.lowest_phi = std::min(report.lowest_phi, net.phi[i] / frame.scale);
    report.share_falling += dot(net.gradient[i], inside.gradient[i]) < 0;
  }
  report.share_falling /= std::max(deep, 1);
  return report;
}

// Farthest vertex of phi's zero set from the body's mesh.
double zero_set_to_mesh(PhiBatch const& phi, Body const& body, BodyFrame const& frame, int threads) {
  ZeroSetOptions options;
  options.radius = 1.1 * body.bounding_radius / frame.scale;
  std::vector<Vec3> vertex = find_zero_set(phi, options).mesh.vertex;
  for (Vec3& v : vertex) v = frame.to_body(v);
  std::vector<double> distance(vertex.size());
  body.distance->evaluate(vertex, distance, {}, threads);
  double farthest = 0;
  for (double d : distance) farthest = std::max(farthest, std::abs(d) / frame.scale);
  return farthest;
}

}  // namespace

InteriorReport certify(PhiBatch const& phi, Body const& body, BodyFrame const& frame, int points, std::uint64_t seed,
                       int threads, Certificate& certificate) {
  Samples const shell = shell_samples(body, points, seed, threads);
  std::vector<double> const error = errors(evaluate(phi, frame, shell.point), shell, frame.scale);
  certificate.mae = mean(error);
  certificate.p99 = percentile(error, 0.99);
  certificate.max = *std::max_element(error.begin(), error.end());
  certificate.hausdorff = zero_set_to_mesh(phi, body, frame, threads);
  certify_surface(phi, body, frame, points, seed + 1, threads, certificate);
  return examine_interior(phi, body, frame, points, seed + 3, threads);
}

}  // namespace scree
