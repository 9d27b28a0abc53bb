// grain_entries.cpp: see grain_entries.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/grain_entries.h"

#include <algorithm>

namespace scree {

std::vector<GrainEntry> entries_of(Case const& c) {
  int const groups = static_cast<int>(c.grains.size());
  // Class 0 holds what meets each other, every entry that keeps apart is a class of its own.
  std::vector<int> own_class(groups, 0);
  int classes = 1;
  for (int g = 0; g < groups; ++g)
    if (c.grains[g].apart) own_class[g] = classes++;
  std::vector<GrainEntry> out;
  int first = 0;
  for (int r = 0; r < c.replicas; ++r)
    for (int g = 0; g < groups; ++g) {
      int const count = c.grains[g].count;
      out.push_back({g, r, first, count, r * classes + own_class[g], replica_seed(c.seed, r)});
      first += count;
    }
  return out;
}

bool has_worlds(std::vector<GrainEntry> const& entries) {
  auto const used = [](GrainEntry const& e) { return e.count > 0; };
  auto const one = std::find_if(entries.begin(), entries.end(), used);
  return std::any_of(entries.begin(), entries.end(),
                     [&](GrainEntry const& e) { return used(e) && e.world != one->world; });
}

std::uint64_t replica_seed(std::uint64_t seed, int replica) {
  if (replica == 0) return seed;
  // Output function of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014), over the seed and then over the replica.
  auto const mix = [](std::uint64_t z) {
    z += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  };
  return mix(mix(seed) + static_cast<std::uint64_t>(replica)) >> 1;
}

std::string name_of(Case const& c, GrainEntry const& entry) {
  std::string const name = "grains '" + c.grains[entry.group].name + "'";
  return c.replicas > 1 ? name + " of replica " + std::to_string(entry.replica) : name;
}

}  // namespace scree
