// insertion.h: grains that enter during a run: insert.kind = "rate".
// All bodies exist from the start; those not yet inserted wait inactive at a corner of their box.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/results.h"
#include "core/state.h"

namespace scree {

// Insertion of `state` for time 0: grains of such entries are pending, unless state.activity says otherwise already.
void start_insertion(Case const& c, Scene const& scene, State& state);

// Activates the grains that are due at state.time, each at a free place of its box; the grain that finds none blocks
// its entry until it does. Energy brought in goes to state.inserted_energy. Drops the pair list when something changed.
// Cost: one pass over all bodies at each step at which a grain is due. Deterministic; no threads.
void insert_due(Queue const& queue, Case const& c, Scene const& scene, State& state, Workspace& work,
                std::vector<std::string>& messages);

// Whether nothing is left to insert; true for cases without insertion over time.
bool all_inserted(Case const& c, State const& state);

// At the end: a line for each entry whose grains are not all in, or had to wait.
void report_insertion(Case const& c, State const& state, std::vector<std::string>& messages);

// When each entry is done, for the plan.
std::vector<std::string> insertion_notes(Case const& c);

}  // namespace scree
