// dataset.cpp: bodies to learn and samples of their signed distance.
// SPDX-License-Identifier: Apache-2.0
#include "training/dataset.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/random.h"

namespace scree {
namespace {

double constexpr outer = 1.1;  // of the bounding radius: the region a network is ever evaluated in
double constexpr inner = 0.9;  // of the inscribed radius: where the paper's shell begins

// Uniform points on a mesh: triangle by area, then barycentric.
class SurfaceSampler {
 public:
  explicit SurfaceSampler(TriangleMesh const& mesh) : mesh_(mesh) {
    double sum = 0;
    for (auto const& [a, b, c] : mesh.triangle) {
      Vec3 const area = cross(mesh.vertex[b] - mesh.vertex[a], mesh.vertex[c] - mesh.vertex[a]);
      outward_.push_back(area / std::max(norm(area), 1e-300));
      cumulative_.push_back(sum += norm(area));
    }
  }
  struct Point {
    Vec3 position, outward;
  };
  Point draw(Random& random) const {
    double const pick = random.uniform(0, cumulative_.back());
    auto const last = static_cast<std::ptrdiff_t>(cumulative_.size()) - 1;
    auto const t = std::min(std::upper_bound(cumulative_.begin(), cumulative_.end(), pick) - cumulative_.begin(), last);
    auto const& [a, b, c] = mesh_.triangle[t];
    double const root = std::sqrt(random.uniform()), v = random.uniform();
    return {mesh_.vertex[a] * (1 - root) + mesh_.vertex[b] * (root * (1 - v)) + mesh_.vertex[c] * (root * v),
            outward_[t]};
  }

 private:
  TriangleMesh const& mesh_;
  std::vector<Vec3> outward_;
  std::vector<double> cumulative_;
};

Vec3 in_shell(double low, double high, Random& random) {
  double const radius = std::cbrt(random.uniform(low * low * low, high * high * high));
  return random.direction() * radius;
}

void measure(Body const& body, Samples& samples, int threads) {
  samples.phi.resize(samples.point.size());
  samples.gradient.resize(samples.point.size());
  body.distance->evaluate(samples.point, samples.phi, samples.gradient, threads);
}

}  // namespace

Body make_body(std::string name, TriangleMesh mesh, std::string source, std::string source_hash) {
  Body body;
  body.distance = std::make_shared<MeshDistance const>(mesh);
  MeshMass const mass = mesh_mass(mesh);
  if (std::abs(mass.volume * 6 / std::numbers::pi - 1) > 1e-6 || norm(mass.centroid) > 1e-6)
    throw std::invalid_argument("make_body: the mesh of " + name + " is not normalised (volume pi/6, centroid at 0)");
  body.inscribed_radius = std::max(body.distance->at({0, 0, 0}).phi, 0.0);
  for (Vec3 const& v : mesh.vertex) body.bounding_radius = std::max(body.bounding_radius, norm(v));
  body.name = std::move(name);
  body.source = std::move(source);
  body.source_hash = std::move(source_hash);
  body.mesh = std::move(mesh);
  return body;
}

Samples training_samples(Body const& body, SamplingOptions const& options, std::uint64_t seed, int threads) {
  Random random(seed);
  SurfaceSampler const surface(body.mesh);
  double const limit = outer * body.bounding_radius;
  Samples samples;
  samples.point.reserve(options.count);
  while (static_cast<int>(samples.point.size()) < options.count) {
    double const kind = random.uniform();
    Vec3 point;
    if (kind < options.share_surface) {
      auto const [position, outward] = surface.draw(random);
      double const band = random.below(5) < 2 ? 4 * options.band : options.band;
      point = position + outward * (band * random.normal());
    } else if (kind < options.share_surface + options.share_interior) {
      auto const [position, outward] = surface.draw(random);
      point = position - outward * random.uniform(0, std::max(body.inscribed_radius, 0.1));
    } else {
      point = in_shell(0, limit, random);
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
    samples.phi.push_back(0);
    samples.gradient.push_back(-outward);
  }
  return samples;
}

}  // namespace scree
