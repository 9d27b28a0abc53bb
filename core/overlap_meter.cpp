// overlap_meter.cpp: see overlap_meter.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/overlap_meter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/wall_surface.h"
#include "shapes/surface_nodes.h"

namespace scree {
namespace {

// Network queries of the prefilter are float with an error of 1e-5: what is further out than this is outside.
double constexpr prefilter_slack = 1e-4;

struct Meter {
  ResultsHeader const& header;
  Frame const& frame;
  std::vector<std::vector<Vec3>> surface;  // of each shape [d]
  std::vector<PhiBatch> sieve;             // of each shape: same zero set as the reference, much cheaper
  std::vector<Mat3> rotation;              // body -> world (n)
  std::vector<WallPhi> wall_phi;           // of each wall body
  std::vector<WallPose> wall_pose;

  Shape const& shape(int body) const { return header.library.shape[header.shape[body]]; }
  double radius(int body) const { return shape(body).bounding_radius * header.diameter[body]; }  // [m]

  // Largest phi [m] of `partner` at the points of `carrier`; 0 when none is inside.
  double side(int carrier, int partner) const {
    Shape const& of = shape(partner);
    double const d = header.diameter[partner], ball = of.bounding_radius * of.bounding_radius;
    Vec3 const offset = frame.position[carrier] - frame.position[partner];
    std::vector<Vec3> near;
    for (Vec3 const p : surface[header.shape[carrier]]) {
      Vec3 const arm = rotation[carrier] * (p * header.diameter[carrier]);
      Vec3 const y = transposed_times(rotation[partner], offset + arm) / d;
      if (norm2(y) <= ball) near.push_back(y);
    }
    std::vector<double> coarse(near.size());
    if (!near.empty()) sieve[header.shape[partner]](near, coarse, {});
    double deepest = 0;
    for (std::size_t i = 0; i < near.size(); ++i)
      if (coarse[i] > -prefilter_slack) deepest = std::max(deepest, evaluate_reference(header.library, of, near[i]));
    return deepest * d;
  }

  double in_plane(int body, ResultsWall const& wall) const {
    Vec3 const normal = transposed_times(rotation[body], wall.normal);
    double lowest = 0;
    double const height = dot(wall.normal, frame.position[body] - wall.point);
    if (height > radius(body)) return 0;
    for (Vec3 const p : surface[header.shape[body]])
      lowest = std::min(lowest, height + header.diameter[body] * dot(normal, p));
    return -lowest;
  }

  // |grad phi| <= 1: no point of a grain whose centre is its radius outside the solid is within it.
  double in_wall_body(int body, int wall) const {
    Mat3 const turn = to_matrix(wall_pose[wall].orientation);
    Vec3 const centre = transposed_times(turn, frame.position[body] - wall_pose[wall].position);
    if (wall_phi[wall](centre) < -radius(body)) return 0;
    double deepest = 0;
    for (Vec3 const p : surface[header.shape[body]]) {
      Vec3 const arm = rotation[body] * (p * header.diameter[body]);
      deepest = std::max(deepest, wall_phi[wall](centre + transposed_times(turn, arm)));
    }
    return deepest;
  }

  double in_wall(int body, int wall) const {
    int const planes = static_cast<int>(header.wall.size());
    return wall < planes ? in_plane(body, header.wall[wall]) : in_wall_body(body, wall - planes);
  }

  OverlapAt measure(int a, int b) const {
    if (b < 0) return {in_wall(a, -1 - b) / header.diameter[a], a, b};
    double const smaller = std::min(header.diameter[a], header.diameter[b]);
    return {std::max(side(a, b), side(b, a)) / smaller, a, b};
  }
};

// Pairs of bodies with overlapping bounding spheres, by a sweep along x, and all bodies with all walls.
std::vector<OverlapAt> candidates(Meter const& meter) {
  std::vector<int> order;
  for (std::size_t i = 0; i < meter.frame.position.size(); ++i)
    if (meter.frame.is_active(i)) order.push_back(static_cast<int>(i));
  int const n = static_cast<int>(order.size());
  auto const left = [&](int i) { return meter.frame.position[i].x - meter.radius(i); };
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return left(i) < left(j); });
  std::vector<OverlapAt> pairs;
  for (int k = 0; k < n; ++k) {
    int const i = order[k];
    double const right = meter.frame.position[i].x + meter.radius(i);
    for (int l = k + 1; l < n && left(order[l]) <= right; ++l) {
      int const j = order[l];
      if (!meter.header.world.empty() && meter.header.world[i] != meter.header.world[j]) continue;
      double const reach = meter.radius(i) + meter.radius(j);
      if (norm2(meter.frame.position[i] - meter.frame.position[j]) <= reach * reach)
        pairs.push_back({0, std::min(i, j), std::max(i, j)});
    }
  }
  std::sort(order.begin(), order.end());
  for (int const i : order)
    for (std::size_t w = 0; w < meter.header.wall.size() + meter.header.wall_body.size(); ++w)
      pairs.push_back({0, i, -1 - static_cast<int>(w)});
  return pairs;
}

Meter make_meter(ResultsHeader const& header, Frame const& frame, int points, int threads) {
  Meter meter{header, frame, {}, {}, {}, {}, {}};
  Library const& library = header.library;
  for (Shape const& s : library.shape) meter.sieve.push_back(surface_phi(library, s));
  for (Quat const q : frame.orientation) meter.rotation.push_back(to_matrix(q));
  for (std::size_t w = 0; w < header.wall_body.size(); ++w) {
    meter.wall_phi.emplace_back(header.wall_body[w]);
    meter.wall_pose.push_back(scree::wall_pose(header, frame, static_cast<int>(w)));
  }
  meter.surface.resize(library.shape.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t s = 0; s < library.shape.size(); ++s)
    meter.surface[s] = make_dense_surface(meter.sieve[s], library.shape[s], points).position;
  return meter;
}

OverlapReport summarise(std::vector<OverlapAt> const& pairs, std::size_t bodies, std::size_t active) {
  OverlapReport report;
  report.of_body.assign(bodies, 0);
  std::vector<double> depth;
  for (OverlapAt const& p : pairs) {
    if (!(p.depth > 0)) continue;
    for (int const body : {p.a, p.b})
      if (body >= 0) report.of_body[body] = std::max(report.of_body[body], p.depth);
    depth.push_back(p.depth);
    report.wall_contacts += p.b < 0;
    OverlapAt& deepest = p.b < 0 ? report.grain_wall : report.grain_grain;
    if (p.depth > deepest.depth) deepest = p;
  }
  if (depth.empty()) return report;
  report.contacts = static_cast<int>(depth.size());
  report.coordination = (2.0 * report.contacts - report.wall_contacts) / static_cast<double>(active);
  std::sort(depth.begin(), depth.end());
  report.mean = std::accumulate(depth.begin(), depth.end(), 0.0) / report.contacts;
  report.p99 = depth[(99 * (depth.size() - 1) + 99) / 100];  // rounded up: the deeper neighbour
  return report;
}

}  // namespace

OverlapReport measure_overlap(ResultsHeader const& header, Frame const& frame, int points_per_grain, int threads) {
  if (frame.position.size() != header.shape.size() || frame.orientation.size() != header.shape.size())
    throw std::invalid_argument("the frame has another number of bodies than the header");
  Meter const meter = make_meter(header, frame, points_per_grain, std::max(1, threads));
  std::vector<OverlapAt> pairs = candidates(meter);
#pragma omp parallel for schedule(dynamic, 4) num_threads(std::max(1, threads))
  for (std::size_t k = 0; k < pairs.size(); ++k) pairs[k] = meter.measure(pairs[k].a, pairs[k].b);
  std::size_t active = 0;
  for (std::size_t i = 0; i < header.shape.size(); ++i) active += frame.is_active(i);
  return summarise(pairs, header.shape.size(), active);
}

}  // namespace scree
