// machine_costs.h: what steps cost on this machine, measured once in a few seconds and kept.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/accuracy.h"

namespace scree {

// From the cache folder where it has them of this processor and this build, else measured: a heap of `grains` of
// `scree cost`'s ellipsoids by their formula at each of `nodes`, the mean of at rest and flowing.
StepCosts machine_costs(std::vector<int> const& nodes = {250, 1000, 4000, 8000}, int grains = 16);

}  // namespace scree
