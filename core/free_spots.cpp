// free_spots.cpp: see free_spots.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/free_spots.h"

#include <algorithm>
#include <cmath>

namespace scree {

double SplitMix::uniform() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
  z = (z ^ z >> 27) * 0x94d049bb133111eb;
  return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
}

// Clamped: where a case puts a grain is its own affair, and beyond this cells are wider than a double can tell apart.
std::int64_t SphereGrid::cell_of(double x) const {
  return static_cast<std::int64_t>(std::clamp(std::floor(x / cell_), -1e15, 1e15));
}

// Far cells may share a key: a bucket then holds spheres that the distance test sorts out.
std::uint64_t SphereGrid::key(std::int64_t x, std::int64_t y, std::int64_t z) const {
  return static_cast<std::uint64_t>(x) * 73856093u ^ static_cast<std::uint64_t>(y) * 19349663u ^
         static_cast<std::uint64_t>(z) * 83492791u;
}

void SphereGrid::add(Vec3 centre, double radius) {
  cells_[key(cell_of(centre.x), cell_of(centre.y), cell_of(centre.z))].push_back({centre, radius});
}

bool SphereGrid::is_free(Vec3 centre, double radius) const {
  Vec3 const reach = Vec3{1, 1, 1} * (radius + largest_), low = centre - reach, high = centre + reach;
  for (std::int64_t z = cell_of(low.z); z <= cell_of(high.z); ++z)
    for (std::int64_t y = cell_of(low.y); y <= cell_of(high.y); ++y)
      for (std::int64_t x = cell_of(low.x); x <= cell_of(high.x); ++x) {
        auto const found = cells_.find(key(x, y, z));
        if (found == cells_.end()) continue;
        for (Sphere const& s : found->second) {
          double const apart = radius + s.radius;
          if (norm2(centre - s.centre) < apart * apart) return false;
        }
      }
  return true;
}

std::optional<Vec3> find_free_spot(Box const& box, double radius, SphereGrid const& grid, WallClearance const& walls,
                                   int tries, std::uint64_t& random) {
  Vec3 const low = box.min + Vec3{1, 1, 1} * radius, room = box.max - box.min - Vec3{1, 1, 1} * (2 * radius);
  if (!(room.x >= 0 && room.y >= 0 && room.z >= 0)) return std::nullopt;
  SplitMix draw(random);
  for (int k = 0; k < tries; ++k) {
    double const u = draw.uniform(), v = draw.uniform(), w = draw.uniform();
    Vec3 const centre = low + multiply(room, Vec3{u, v, w});
    if (walls.is_clear(centre, radius) && grid.is_free(centre, radius)) return centre;
  }
  return std::nullopt;
}

}  // namespace scree
