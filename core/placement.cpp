// placement.cpp: see placement.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/placement.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {
namespace {

// Uniform rotation (Shoemake 1992).
Quat random_orientation(std::mt19937_64& random) {
  double const tau = 6.283185307179586;
  double const u = uniform(random), v = tau * uniform(random), w = tau * uniform(random);
  double const a = std::sqrt(1 - u), b = std::sqrt(u);
  return {b * std::cos(w), a * std::sin(v), a * std::cos(v), b * std::sin(w)};
}

bool same_box(Box const& a, Box const& b) { return a.min == b.min && a.max == b.max; }

struct Lattice {
  Vec3 origin;
  double cell = 0;
  int n[3] = {};
  long used = 0;

  long capacity() const { return static_cast<long>(n[0]) * n[1] * n[2]; }
  Vec3 site(long i) const {
    return origin + Vec3{(i % n[0] + 0.5) * cell, (i / n[0] % n[1] + 0.5) * cell, (i / n[0] / n[1] + 0.5) * cell};
  }
};

// Lattice of all entries that share the box of `c.grains[group]`.
Lattice lattice_for(Case const& c, Scene const& scene, Box const& box) {
  Lattice lattice;
  for (int i = 0; i < scene.bodies(); ++i) {
    InsertCase const& insert = c.grains[scene.group_of[i]].insert;
    if (insert.kind == InsertCase::Kind::lattice && same_box(insert.box, box))
      lattice.cell = std::max(lattice.cell, 2 * scene.shape[scene.shape_of[i]].bounding_radius * scene.diameter[i]);
  }
  lattice.cell *= 1 + 1e-6;  // bounding spheres of neighbours do not touch, rounded either way
  Vec3 const size = box.max - box.min;
  for (int k = 0; k < 3; ++k) {
    lattice.n[k] = static_cast<int>(std::min(1e6, std::floor(size[k] / lattice.cell)));
    // Centred across, from the bottom up.
    lattice.origin[k] = box.min[k] + (k < 2 ? 0.5 * (size[k] - lattice.n[k] * lattice.cell) : 0);
  }
  return lattice;
}

}  // namespace

std::mt19937_64 random_stream(std::uint64_t seed, int group, Draw purpose) {
  std::seed_seq sequence{seed, seed >> 32, static_cast<std::uint64_t>(group), static_cast<std::uint64_t>(purpose)};
  return std::mt19937_64(sequence);
}

std::vector<int> assign_shapes(Case const& c, int group, std::vector<int> const& templates) {
  int const n = c.grains[group].count;
  std::vector<int> shape(n);
  for (int i = 0; i < n; ++i) shape[i] = templates[i % templates.size()];
  std::mt19937_64 random = random_stream(c.seed, group, Draw::shapes);
  for (int i = n - 1; i > 0; --i) std::swap(shape[i], shape[static_cast<int>(uniform(random) * (i + 1))]);
  return shape;
}

Placement place_grains(Case const& c, Scene const& scene, std::vector<std::string>& found) {
  Placement out;
  std::vector<std::pair<Box, Lattice>> lattices;
  int body = 0;
  for (std::size_t g = 0; g < c.grains.size(); ++g) {
    InsertCase const& insert = c.grains[g].insert;
    std::mt19937_64 random = random_stream(c.seed, static_cast<int>(g), Draw::poses);
    Lattice* lattice = nullptr;
    if (insert.kind == InsertCase::Kind::lattice && c.grains[g].count > 0) {
      auto at =
          std::find_if(lattices.begin(), lattices.end(), [&](auto const& l) { return same_box(l.first, insert.box); });
      if (at == lattices.end()) at = lattices.insert(lattices.end(), {insert.box, lattice_for(c, scene, insert.box)});
      lattice = &at->second;
      if (lattice->used + c.grains[g].count > lattice->capacity()) {
        found.push_back("grains '" + c.grains[g].name + "': insert.box holds " + std::to_string(lattice->capacity()) +
                        " grains (cell " + std::to_string(lattice->cell) + " m), but " +
                        std::to_string(lattice->used + c.grains[g].count) +
                        " are to start in it. Make the box larger or count smaller.");
        return out;
      }
    }
    for (int i = 0; i < c.grains[g].count; ++i, ++body) {
      out.position.push_back(lattice ? lattice->site(lattice->used++) : insert.position[i]);
      Quat orientation;
      if (!insert.quaternion.empty())
        orientation = normalized(insert.quaternion[i]);
      else if (insert.orientation == Orientation::random)
        orientation = random_orientation(random);
      out.orientation.push_back(orientation);
      out.velocity.push_back(insert.velocity);
      out.spin.push_back(insert.spin);
    }
  }
  return out;
}

}  // namespace scree
