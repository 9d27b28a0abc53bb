// mesh_samples.cpp: see mesh_samples.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_samples.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "shapes/random.h"

namespace scree {
namespace {

int constexpr candidates_per_point = 6;
double constexpr shrink = 0.93;  // of the radius from pass to pass

PointCloud uniform_over_area(TriangleMesh const& mesh, int count, Random& random) {
  std::vector<double> until(mesh.triangle.size());  // area of the triangles up to and with this one
  double total = 0;
  auto const area_vector = [&](std::size_t t) {
    auto const& [a, b, c] = mesh.triangle[t];
    return cross(mesh.vertex[b] - mesh.vertex[a], mesh.vertex[c] - mesh.vertex[a]) * 0.5;
  };
  for (std::size_t t = 0; t < until.size(); ++t) until[t] = total += norm(area_vector(t));
  if (!(total > 0)) throw std::invalid_argument("sample_mesh: the mesh has no area");
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    auto const at = std::upper_bound(until.begin(), until.end(), random.uniform() * total);
    std::size_t const t = std::min<std::size_t>(at - until.begin(), until.size() - 1);
    double const root = std::sqrt(random.uniform()), v = random.uniform();  // uniform in the triangle
    auto const& [a, b, c] = mesh.triangle[t];
    cloud.position.push_back(mesh.vertex[a] * (1 - root) + mesh.vertex[b] * (root * (1 - v)) +
                             mesh.vertex[c] * (root * v));
    cloud.normal.push_back(normalized(area_vector(t)));
  }
  return cloud;
}

// Points that were taken, in cells as wide as the largest radius.
class TakenPoints {
 public:
  explicit TakenPoints(double cell) : inverse_cell_(1 / cell) {}

  bool is_free(Vec3 x, double radius) const {
    Cell const c = cell_of(x);
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) {
          auto const at = point_.find(key({c.i + i, c.j + j, c.k + k}));
          if (at == point_.end()) continue;
          for (Vec3 const& p : at->second)
            if (norm2(p - x) < radius * radius) return false;
        }
    return true;
  }
  void add(Vec3 x) { point_[key(cell_of(x))].push_back(x); }

 private:
  struct Cell {
    std::int64_t i, j, k;
  };
  Cell cell_of(Vec3 x) const {
    auto const index = [&](double u) { return static_cast<std::int64_t>(std::floor(u * inverse_cell_)); };
    return {index(x.x), index(x.y), index(x.z)};
  }
  // Cells that share a key only cost time.
  static std::uint64_t key(Cell c) {
    return static_cast<std::uint64_t>(c.i) * 73856093u ^ static_cast<std::uint64_t>(c.j) * 19349663u ^
           static_cast<std::uint64_t>(c.k) * 83492791u;
  }

  double inverse_cell_;
  std::unordered_map<std::uint64_t, std::vector<Vec3>> point_;
};

}  // namespace

PointCloud sample_mesh(TriangleMesh const& mesh, int count, std::uint64_t seed) {
  if (count < 1) throw std::invalid_argument("sample_mesh: count must be positive");
  Random random(seed);
  PointCloud const candidate = uniform_over_area(mesh, count * candidates_per_point, random);
  // Disks of this diameter in hexagonal packing would cover the area with `count` of them.
  double radius = std::sqrt(2 * mesh_mass(mesh).area / (std::sqrt(3.0) * count));
  TakenPoints taken(radius);
  std::vector<char> used(candidate.position.size(), 0);
  PointCloud cloud;
  for (int left = count; left > 0; radius *= shrink)
    for (std::size_t i = 0; i < used.size() && left > 0; ++i) {
      if (used[i] || !taken.is_free(candidate.position[i], radius)) continue;
      used[i] = 1;
      --left;
      taken.add(candidate.position[i]);
      cloud.position.push_back(candidate.position[i]);
      cloud.normal.push_back(candidate.normal[i]);
    }
  return cloud;
}

}  // namespace scree
