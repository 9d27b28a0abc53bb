// cost_queries.cpp: single queries of `scree cost`, see cost_meters.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "shapes/analytic_shapes.h"
#include "shapes/certify_phi.h"
#include "shapes/random.h"
#include "shapes/support_points.h"
#include "tools/cost_meters.h"

namespace scree {
namespace {

double seconds_of(std::function<void()> const& work) {
  double const begin = process_seconds();
  work();
  return process_seconds() - begin;
}

// Points to ask body 0 at.
QueryBatch batch_for(Simulation::Impl const& s, std::vector<Vec3> const& point) {
  ShapeRecord const& shape = s.scene.shape[s.scene.shape_of[0]];
  int const networks = static_cast<int>(s.scene.networks.net.size()), n = static_cast<int>(point.size());
  QueryBatch batch;
  batch.resize(n);
  batch.point = point;
  batch.gradient.resize(n);
  std::fill(batch.partner.begin(), batch.partner.end(), 0);
  int const group = query_group(shape.sdf, shape.net, networks);
  for (int g = 0; g <= query_groups(networks); ++g) batch.group.push_back(g <= group ? 0 : n);
  return batch;
}

double mean(std::vector<double> const& values) {
  double sum = 0;
  for (double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

}  // namespace

QueryPoints truth_points(int count, double spread) {
  Library library;
  library.shape = {builtin_shape(cost_truth)};
  PhiBatch const phi = reference_phi(library, library.shape[0]);
  QueryPoints out;
  out.point = quasi_uniform_directions(count);
  for (Vec3& p : out.point) p = multiply(p, library.shape[0].analytic.half_size);
  out.phi.resize(count);
  out.gradient.resize(count);
  phi(out.point, out.phi, out.gradient);
  if (spread > 0) {
    Random random(3);
    for (int i = 0; i < count; ++i) out.point[i] += out.gradient[i] * random.uniform(-spread, spread);
    // Beyond the bounding sphere nothing is asked: phi is the distance to it by definition.
    double const ball = 0.99 * library.shape[0].bounding_radius;
    std::erase_if(out.point, [&](Vec3 p) { return norm(p) > ball; });
    out.phi.resize(out.point.size());
    out.gradient.resize(out.point.size());
    phi(out.point, out.phi, out.gradient);
  }
  return out;
}

void measure_queries(Simulation& simulation, QueryPoints const& band, QueryPoints const& surface, QueryRow& row) {
  Simulation::Impl const& s = simulation.impl();
  SceneView const scene = s.scene.view();
  Queue const one{};
  QueryBatch batch = batch_for(s, band.point);
  row.phi_seconds.push_back(seconds_of([&] { evaluate_phi(one, scene, s.scene.networks, batch); }));
  std::vector<double> error;
  for (std::size_t i = 0; i < band.phi.size(); ++i) error.push_back(std::abs(batch.phi[i] - band.phi[i]));
  row.phi_mean = mean(error);
  row.phi_largest = *std::max_element(error.begin(), error.end());
  batch = batch_for(s, surface.point);
  row.gradient_seconds.push_back(seconds_of([&] { evaluate_phi_gradient(one, scene, s.scene.networks, batch); }));
  std::vector<double> angle;
  for (std::size_t i = 0; i < surface.phi.size(); ++i) {
    Vec3 const g = batch.gradient[i], exact = surface.gradient[i];
    angle.push_back(std::atan2(norm(cross(g, exact)), dot(g, exact)) * 180 / std::numbers::pi);
  }
  row.normal_mean = mean(angle);
  row.normal_p95 = percentile(angle, 0.95);
  row.phi_ns = 1e9 * median(row.phi_seconds) / static_cast<double>(band.point.size());
  row.gradient_ns = 1e9 * median(row.gradient_seconds) / static_cast<double>(surface.point.size());
  Certificate const& certificate = s.scene.library.shape[0].certificate;
  row.certificate_phi = certificate.band_mae;
  row.certificate_normal = certificate.normal_p95;
  for (Plan::Array const& a : simulation.plan().arrays)
    if (a.name == "networks" || a.name == "grids" || a.name == "meshes" || a.name == "radii") row.bytes = a.bytes;
}

}  // namespace scree
