// unique_grains.h: grains that keep 16-bit radii in a scene: library shapes with storage = "compact", and many unique
// grains of one decoder made straight from their codes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "core/scene.h"

namespace scree {

// Makers of compact grains by decoder and node count, each with its place among the scene's direction sets.
class CompactMakers {
 public:
  // `libraries` must outlive this. Throws what CompactGrainMaker throws.
  CompactMakers(std::vector<Library> const& libraries, Scene& scene) : libraries_(libraries), scene_(scene) {}
  struct Entry {
    std::unique_ptr<CompactGrainMaker> maker;
    int set;  // of Scene::compact.directions
  };
  Entry const& get(int library, int net, int nodes);

 private:
  std::vector<Library> const& libraries_;
  Scene& scene_;
  std::map<std::tuple<int, int, int>, Entry> entry_;
};

// The network of a scene that evaluates `net`; added when it is new. Compares by content: call it once a decoder.
int scene_network(Scene& scene, Mlp const& net);

struct UniqueGrainsMade {
  int made = 0;
  std::array<int, 4> faults{};  // by GrainFault: codes that gave no grain
};

// A template for every code whose body is star-shaped, in the order of the codes, behind all templates there are.
// `codes`: one after the other; `net`: of Scene::networks, the maker's. About 3 ms a grain and thread; the result does
// not depend on `threads`. Names are `name` + 0, 1, ... of the grains made.
UniqueGrainsMade add_unique_grains(Scene& scene, CompactGrainMaker const& maker, int net, Span<const float> codes,
                                   std::string name, int threads);

// What a scene keeps for its compact templates, from the capacity of its arrays [bytes].
struct CompactBytes {
  std::size_t grains = 0;
  std::size_t nodes = 0, culling = 0, bias = 0, record = 0, host = 0;  // host: code, mass, name, certificate
  std::size_t total() const { return nodes + culling + bias + record + host; }
};
CompactBytes compact_bytes(Scene const& scene);

}  // namespace scree
