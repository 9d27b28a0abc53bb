// placement.h: which shape each grain gets and where it starts. Seeded; the same on every machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/grain_entries.h"
#include "core/scene.h"

namespace scree {

// Random numbers of entry `group` for one purpose: streams of a seed that do not depend on how much another one draws.
enum class Draw : std::uint64_t { shapes = 1, poses = 2, codes = 3, places = 4, sizes = 5, scatter = 6 };
std::mt19937_64 random_stream(std::uint64_t seed, int group, Draw purpose);

// Uniform in [0, 1) from the top 53 bits: std::uniform_real_distribution differs between standard libraries.
inline double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Template of each grain of an entry: equal shares of `templates`, shuffled with the replica's seed, unless the entry
// chooses them itself.
std::vector<int> assign_shapes(Case const& c, GrainEntry const& entry, std::vector<int> const& templates);

// Starting poses. Worlds know nothing of each other. Entries with the same lattice box share one lattice, its cell the
// largest bounding diameter among them, so nothing overlaps at the start; random places keep bounding spheres apart
// from each other, from walls and from all that starts elsewhere. Grains that are inserted later wait at a corner of
// their box. Appends to `found` when a box is too small.
Placement place_grains(Case const& c, Scene const& scene, std::vector<std::string>& found);

}  // namespace scree
