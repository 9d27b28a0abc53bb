// free_spots.h: random places in a box where a bounding sphere meets no other and no wall.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/wall_clearance.h"

namespace scree {

// Random numbers whose whole state is one word, so that a checkpoint can hold it (Steele, Lea, Flood, OOPSLA 2014).
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t& state) : state_(state) {}
  double uniform();  // [0, 1)

 private:
  std::uint64_t& state_;
};

// Spheres in a grid of cells as wide as the largest of them.
class SphereGrid {
 public:
  explicit SphereGrid(double largest_radius) : largest_(largest_radius), cell_(2 * largest_radius) {}
  void add(Vec3 centre, double radius);
  bool is_free(Vec3 centre,
               double radius) const;  // touching is free; cost: the spheres of 27 cells for radii of a kind

 private:
  std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) const;
  std::int64_t cell_of(double x) const;

  double largest_, cell_;
  struct Sphere {
    Vec3 centre;
    double radius;
  };
  std::unordered_map<std::uint64_t, std::vector<Sphere>> cells_;
};

// A sphere that lies in the box, clear of all walls and meets no sphere of the grid: the first that fits of `tries`
// uniform draws; none when all are taken or the box is thinner than the sphere.
std::optional<Vec3> find_free_spot(Box const& box, double radius, SphereGrid const& grid, WallClearance const& walls,
                                   int tries, std::uint64_t& random);

}  // namespace scree
