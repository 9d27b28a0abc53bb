// placement.h: which shape each grain gets and where it starts. Seeded; the same on every machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/scene.h"

namespace scree {

// Template of each grain of entry `group`: equal shares of `templates`, shuffled with the case's seed.
std::vector<int> assign_shapes(Case const& c, int group, std::vector<int> const& templates);

// Starting poses. Entries with the same lattice box share one lattice, its cell the largest bounding diameter among
// them, so nothing overlaps at the start. Appends to `found` when a box is too small.
Placement place_grains(Case const& c, Scene const& scene, std::vector<std::string>& found);

}  // namespace scree
