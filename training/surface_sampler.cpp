// surface_sampler.cpp: see surface_sampler.h.
// SPDX-License-Identifier: Apache-2.0
#include "training/surface_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace scree {
namespace {

// Index of the first entry above a uniform draw; cumulative sums ascend.
std::size_t pick(std::vector<double> const& cumulative, Random& random) {
  double const at = random.uniform(0, cumulative.back());
  auto const last = static_cast<std::ptrdiff_t>(cumulative.size()) - 1;
  return static_cast<std::size_t>(
      std::min(std::upper_bound(cumulative.begin(), cumulative.end(), at) - cumulative.begin(), last));
}

}  // namespace

SurfaceSampler::SurfaceSampler(TriangleMesh const& mesh, bool curved) : mesh_(mesh) {
  double sum = 0;
  for (auto const& [a, b, c] : mesh.triangle) {
    Vec3 const area = cross(mesh.vertex[b] - mesh.vertex[a], mesh.vertex[c] - mesh.vertex[a]);
    outward_.push_back(area / std::max(norm(area), 1e-300));
    cumulative_.push_back(sum += norm(area));
  }
  if (!curved) return;
  double bending = 0;
  std::unordered_map<std::uint64_t, int> other;  // triangle on the first side met of each edge
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      int const a = mesh.triangle[t][k], b = mesh.triangle[t][(k + 1) % 3];
      std::uint64_t const key = std::uint64_t(std::min(a, b)) << 32 | std::uint64_t(std::max(a, b));
      auto const [at, fresh] = other.try_emplace(key, static_cast<int>(t));
      if (fresh) continue;
      Vec3 const n = outward_[at->second], m = outward_[t];
      double const angle = std::atan2(norm(cross(n, m)), dot(n, m));
      edge_.push_back({a, b});
      edge_cumulative_.push_back(bending += angle * norm(mesh.vertex[b] - mesh.vertex[a]));
    }
}

SurfaceSampler::Point SurfaceSampler::draw(Random& random) const {
  std::size_t const t = pick(cumulative_, random);
  auto const& [a, b, c] = mesh_.triangle[t];
  double const root = std::sqrt(random.uniform()), v = random.uniform();
  return {mesh_.vertex[a] * (1 - root) + mesh_.vertex[b] * (root * (1 - v)) + mesh_.vertex[c] * (root * v),
          outward_[t]};
}

Vec3 SurfaceSampler::draw_curved(Random& random) const {
  Edge const edge = edge_[pick(edge_cumulative_, random)];
  double const share = random.uniform();
  return mesh_.vertex[edge.a] * (1 - share) + mesh_.vertex[edge.b] * share;
}

}  // namespace scree
