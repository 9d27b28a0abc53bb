// wall_surfaces.h: triangles of the walls that are not planes at rest, for pictures and ParaView.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/results.h"
#include "core/scene.h"

namespace scree {

// One surface for each wall body that has one, in the world at time 0. Formulas are cut into facets of 4 degrees; of a
// cylinder that moves the mantle stands for the whole. glass: grains are behind it, it must not hide them.
std::vector<ResultsSurface> wall_surfaces(Case const& c, Scene const& scene);

}  // namespace scree
