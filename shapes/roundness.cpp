// roundness.cpp: see roundness.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/roundness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shapes/nearest_site.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

Vec3 area_vector(TriangleMesh const& mesh, std::array<int, 3> const& t) {
  return cross(mesh.vertex[t[1]] - mesh.vertex[t[0]], mesh.vertex[t[2]] - mesh.vertex[t[0]]) / 2;
}

// Larger principal curvature of a triangle, convex positive: the tensor that best explains how the normal changes along
// its three sides (Rusinkiewicz 2004, section 3). 0 for a splinter.
double largest_curvature(TriangleMesh const& mesh, std::vector<Vec3> const& normal, std::array<int, 3> const& t) {
  Vec3 const u = normalized(mesh.vertex[t[1]] - mesh.vertex[t[0]]);
  Vec3 const v = cross(normalized(area_vector(mesh, t)), u);
  // Least squares for (a, b, c) of the tensor [a b; b c]: a x + b y = p, b x + c y = q a side.
  double xx = 0, xy = 0, yy = 0, px = 0, mixed = 0, qy = 0;
  for (int k = 0; k < 3; ++k) {
    Vec3 const side = mesh.vertex[t[(k + 1) % 3]] - mesh.vertex[t[k]], change = normal[t[(k + 1) % 3]] - normal[t[k]];
    double const x = dot(side, u), y = dot(side, v), p = dot(change, u), q = dot(change, v);
    xx += x * x, xy += x * y, yy += y * y;
    px += p * x, mixed += p * y + q * x, qy += q * y;
  }
  double const trace = xx + yy, determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-6 * trace * trace)) return 0;
  // b from the Schur complement of the normal equations [xx xy 0; xy xx+yy xy; 0 xy yy].
  double const b = (mixed - xy * px / xx - xy * qy / yy) / (trace - xy * xy / xx - xy * xy / yy);
  double const a = (px - xy * b) / xx, c = (qy - xy * b) / yy;
  return 0.5 * (a + c) + std::sqrt(0.25 * (a - c) * (a - c) + b * b);
}

}  // namespace

double inscribed_radius(TriangleMesh const& mesh, std::vector<Vec3> const& normal) {
  Vec3 low = mesh.vertex.at(0), high = low;
  for (Vec3 const& x : mesh.vertex)
    for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
  double const spacing = std::sqrt(mesh_mass(mesh).area / static_cast<double>(mesh.vertex.size()));
  NearestSite const nearest(mesh.vertex, normal, 2 * spacing);
  auto const depth = [&](Vec3 x) {
    int const site = nearest.find(x, {});
    Vec3 const to_surface = mesh.vertex[site] - x;
    return dot(to_surface, normal[site]) > 0 ? norm(to_surface) : -norm(to_surface);
  };
  int constexpr starts = 5, kept = 2, rounds = 24;
  std::vector<std::pair<double, Vec3>> ball;
  for (int i = 0; i < starts * starts * starts; ++i) {
    Vec3 const share{(i % starts + 0.5) / starts, (i / starts % starts + 0.5) / starts,
                     (i / starts / starts + 0.5) / starts};
    Vec3 const x = low + multiply(high - low, share);
    ball.emplace_back(depth(x), x);
  }
  std::stable_sort(ball.begin(), ball.end(), [](auto const& a, auto const& b) { return a.first > b.first; });
  double best = 0;
  for (int s = 0; s < kept; ++s) {
    auto [radius, centre] = ball[s];
    // The depth has ridges, along which only some directions climb: new ones every round.
    double step = norm(high - low) / (2 * starts);
    for (int round = 0; round < rounds; ++round) {
      auto [most, to] = std::pair(radius, centre);
      for (Vec3 const& d : quasi_uniform_directions(12, 0.7 * round))
        if (double const there = depth(centre + d * step); there > most) most = there, to = centre + d * step;
      if (most > radius)
        radius = most, centre = to;
      else
        step *= 0.5;
    }
    best = std::max(best, radius);
  }
  return best;
}

double roundness(TriangleMesh const& mesh, std::vector<Vec3> const& normal) {
  double const ball = inscribed_radius(mesh, normal);
  double corner_area = 0, turning = 0;
  for (auto const& t : mesh.triangle) {
    double const curvature = largest_curvature(mesh, normal, t);
    if (!(curvature * ball > 1)) continue;
    double const area = norm(area_vector(mesh, t));
    corner_area += area;
    turning += area * curvature;
  }
  return turning > 0 ? corner_area / (turning * ball) : 1;
}

}  // namespace scree
