// wall_record.h: what a results file keeps of a scene's walls.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/results.h"
#include "core/scene.h"

namespace scree {

ResultsWall recorded_plane(WallCase const& wall, PlaneRecord const& plane);

// In the order of scene.wall. Of endless solids with what bounds them in the case, so that a drum is drawn as a drum.
std::vector<ResultsWallBody> recorded_wall_bodies(Case const& c, Scene const& scene);

}  // namespace scree
