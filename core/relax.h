// relax.h: starting overlaps are pushed apart before time runs: in bounded steps, ending at rest or refused.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/contacts.h"

namespace scree {

// Moves grains along their contact forces until no pair overlaps by more than relax.overlap of its smaller d. Nothing
// flies: each pass moves no point of a body further than relax.travel of its d, and velocities stay what they were.
// Pairs that push nobody, such as equal grains in one place, and those that hold each other where no small move helps,
// part along a direction that their indices give. The same
// bits for any number of threads. Returns what happened, for the log: passes, overlap before and after, energy removed.
// Throws InputError naming the deepest pair when relax.passes do not suffice. Cost: one contact search a pass.
std::string relax_overlaps(Queue const& queue, Case const& c, Scene const& scene, Effects const& effects,
                           ContactSettings const& settings, State& state, Workspace& work);

}  // namespace scree
