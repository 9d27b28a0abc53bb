// measure_worlds.h: what kinds of measurements say where grains never meet: replicas, and entries that keep apart.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/case.h"

namespace scree {

// Most kinds add such grains up or take all for their mean; these are the others.
// For kinds that tell of one heap, one bed, one opening. Empty, or what is wrong and the way out.
std::string check_one_scene(Case const& c, MeasureCase const& m);

// For kinds that give the mean over replicas: entries that keep apart have none.
std::string check_mean_of_replicas(Case const& c, MeasureCase const& m);

}  // namespace scree
