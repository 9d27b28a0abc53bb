// deletion.h: grains that leave during a run: [[delete]].
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/state.h"

namespace scree {

// Activity of `state` for time 0, where it has none yet, and its counts.
void start_deletion(Case const& c, Scene const& scene, State& state);

// At a synchronised point: bodies in a region of the case become inactive where they are, at rest. What they had, with
// the elastic energy of their contacts, goes to state.deleted_energy; the bodies they touched lose that force at once.
// Drops the pair list when something changed.
void delete_leaving(Queue const& queue, Case const& c, Scene const& scene, State& state, Workspace& work);

// At the end: how many each entry took.
void report_deletion(Case const& c, State const& state, std::vector<std::string>& messages);

}  // namespace scree
