// surroundings.h: where a run takes place: what leaves it is told, once, since nothing would bring it back.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state.h"

namespace scree {

// Box around all grains at the start and all walls, grown by its own diagonal on every side. Empty without walls:
// where nothing holds grains, nothing can be left.
Box surroundings_of(Scene const& scene, State const& start);

// First active grain whose centroid is outside; -1: none.
int first_outside(Box const& surroundings, Scene const& scene, State const& state);

}  // namespace scree
