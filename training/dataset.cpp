// dataset.cpp: bodies to learn and samples of their signed distance.
// SPDX-License-Identifier: Apache-2.0
#include "training/dataset.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/phi_batch.h"
#include "shapes/zero_set.h"
#include "training/surface_sampler.h"

namespace scree {
namespace {

double constexpr outer = 1.1;  // of the bounding radius: the region a network is ever evaluated in
double constexpr inner = 0.9;  // of the inscribed radius: where the paper's shell begins

Vec3 in_shell(double low, double high, Random& random) {
  double const radius = std::cbrt(random.uniform(low * low * low, high * high * high));
  return random.direction() * radius;
}

void measure(Body const& body, Samples& samples, int threads) {
  samples.phi.resize(samples.point.size());
  samples.gradient.resize(samples.point.size());
  body.distance->evaluate(samples.point, samples.phi, samples.gradient, threads);
}

double depth_of_centroid(Body const& body) {
  Vec3 const centre;
  double phi = 0;
  body.distance->evaluate({&centre, 1}, {&phi, 1}, {});
  return std::max(phi, 0.0);
}

}  // namespace

Body make_body(std::string name, TriangleMesh mesh, std::string source, std::string source_hash) {
  Body body;
  body.distance = mesh_truth(mesh);
  MeshMass const mass = mesh_mass(mesh);
  if (std::abs(mass.volume * 6 / std::numbers::pi - 1) > 1e-6 || norm(mass.centroid) > 1e-6)
    throw std::invalid_argument("make_body: the mesh of " + name + " is not normalised (volume pi/6, centroid at 0)");
  body.inertia = {mass.inertia.row[0].x, mass.inertia.row[1].y, mass.inertia.row[2].z};
  body.inscribed_radius = depth_of_centroid(body);
  for (Vec3 const& v : mesh.vertex) body.bounding_radius = std::max(body.bounding_radius, norm(v));
  body.name = std::move(name);
  body.source = std::move(source);
  body.source_hash = std::move(source_hash);
  body.mesh = std::move(mesh);
  return body;
}

Body make_body(std::string name, Shape const& analytic) {
  if (analytic.kind != ShapeKind::analytic)
    throw std::invalid_argument("make_body: " + name + " is a " + to_string(analytic.kind) + ", no formula");
  Body body;
  body.name = std::move(name);
  body.source = analytic.name;
  body.distance = analytic_truth(analytic.analytic);
  body.exact_mesh = false;
  body.inertia = analytic.inertia;
  body.bounding_radius = analytic.bounding_radius;
  body.inscribed_radius = depth_of_centroid(body);
  PhiBatch const phi = surface_phi({}, analytic);
  int constexpr cells = 48;  // refined once: about 40,000 triangles, sharp edges recovered
  body.mesh = refine(phi, find_zero_set(phi, {1.05 * analytic.bounding_radius, cells, 1.0})).mesh;
  return body;
}

Samples training_samples(Body const& body, SamplingOptions const& options, std::uint64_t seed, int threads) {
  Random random(seed);
  SurfaceSampler const surface(body.mesh, options.share_curved > 0);
  bool const shell = options.region == SampleRegion::paper_shell;
  double const low = shell ? inner * body.inscribed_radius : 0, limit = outer * body.bounding_radius;
  auto const band = [&] { return random.below(5) < 2 ? 4 * options.band : options.band; };
  Samples samples;
  samples.point.reserve(options.count);
  while (static_cast<int>(samples.point.size()) < options.count) {
    double const kind = random.uniform();
    Vec3 point;
    if (kind < options.share_surface) {
      auto const [position, outward] = surface.draw(random);
      double const width = band();
      point = position + outward * (width * random.normal());
    } else if (kind < options.share_surface + options.share_curved) {
      double const width = band();
      point = surface.draw_curved(random) + random.direction() * std::abs(width * random.normal());
    } else if (kind < options.share_surface + options.share_curved + options.share_interior) {
      auto const [position, outward] = surface.draw(random);
      point = position - outward * random.uniform(0, std::max(body.inscribed_radius, 0.1));
    } else {
      point = in_shell(low, limit, random);
    }
    if (norm(point) <= limit) samples.point.push_back(point);
  }
  measure(body, samples, threads);
  return samples;
}

Samples shell_samples(Body const& body, int count, std::uint64_t seed, int threads) {
  Random random(seed);
  Samples samples;
  for (int i = 0; i < count; ++i)
    samples.point.push_back(in_shell(inner * body.inscribed_radius, outer * body.bounding_radius, random));
  measure(body, samples, threads);
  return samples;
}

Samples surface_samples(Body const& body, int count, std::uint64_t seed) {
  Random random(seed);
  SurfaceSampler const surface(body.mesh);
  Samples samples;
  for (int i = 0; i < count; ++i) {
    auto const [position, outward] = surface.draw(random);
    samples.point.push_back(position);
    samples.gradient.push_back(-outward);
  }
  if (!body.exact_mesh) {  // from the chords onto the surface
    std::vector<double> phi(samples.point.size());
    body.distance->evaluate(samples.point, phi, samples.gradient);
    for (std::size_t i = 0; i < phi.size(); ++i) samples.point[i] -= samples.gradient[i] * phi[i];
  }
  samples.phi.assign(samples.point.size(), 0);
  return samples;
}

}  // namespace scree
