// pile_tiles.cpp: see pile_tiles.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/pile_tiles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/simulation_impl.h"
#include "shapes/random.h"

namespace scree {

Case pile_case(Case heap) {
  heap.name = "pile";
  WallCase floor;
  floor.name = "floor";
  floor.material = heap.wall[0].material;
  heap.wall = {floor};
  if (heap.grains[0].shapes == std::vector<std::string>{"sphere"})
    for (ContactCase& contact : heap.contact) contact.rolling = RollingCase{.friction = 0.3};
  return heap;
}

Pile settle_pile(Case const& c, int threads) {
  Simulation s(c, {.threads = threads});
  while (s.step() == RunState::running) {
  }
  Frame const end = s.frame();
  Scene const& scene = s.impl().scene;
  Pile pile{c, end.position, end.orientation, {}, empty_box()};
  for (int i = 0; i < scene.bodies(); ++i) {
    pile.shape.push_back(scene.shape_of[i]);  // one entry: its shapes are the templates
    double const r = scene.library.shape[scene.shape_of[i]].bounding_radius * scene.diameter[i];
    for (int k = 0; k < 3; ++k) {
      pile.box.min[k] = std::min(pile.box.min[k], end.position[i][k] - r);
      pile.box.max[k] = std::max(pile.box.max[k], end.position[i][k] + r);
    }
  }
  return pile;
}

Case tiled_case(Pile const& pile, int tiles, bool shuffled, std::uint64_t seed) {
  Case c = pile.c;
  GrainsCase& g = c.grains[0];
  auto const n = pile.position.size();
  std::vector<std::size_t> from(n * tiles);  // body -> grain of the pile + n tile
  std::iota(from.begin(), from.end(), std::size_t{0});
  Random random(seed);
  if (shuffled)
    for (std::size_t i = from.size(); i > 1; --i) std::swap(from[i - 1], from[random.below(static_cast<int>(i))]);
  int const across = static_cast<int>(std::ceil(std::sqrt(tiles)));
  double const wide = pile.box.max.x - pile.box.min.x + g.diameter, deep = pile.box.max.y - pile.box.min.y + g.diameter;
  g.count = static_cast<int>(from.size());
  g.insert = {};
  g.insert.kind = InsertCase::Kind::list;
  for (std::size_t const k : from) {
    int const tile = static_cast<int>(k / n);
    g.insert.position.push_back(pile.position[k % n] + Vec3{tile % across * wide, tile / across * deep, 0});
    g.insert.quaternion.push_back(pile.orientation[k % n]);
    g.insert.shape.push_back(pile.shape[k % n]);
  }
  c.time.settle.reset();
  return c;
}

}  // namespace scree
