// grain_entries.h: the [[grains]] entries of all replicas of a case, in the order of their bodies.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/case.h"

namespace scree {

// One [[grains]] entry of one replica. Replicas stand one after the other, each with its entries in the case's order.
struct GrainEntry {
  int group;           // of Case::grains
  int replica;         // from 0
  int first, count;    // its bodies
  int world;           // bodies of different worlds never meet: one a replica and class of entries
  std::uint64_t seed;  // of its replica
};

// As many for each replica as the case has entries; entry `replica * grains + group`.
std::vector<GrainEntry> entries_of(Case const& c);

// Whether entries with grains live in more than one world.
bool has_worlds(std::vector<GrainEntry> const& entries);

// Seed of a replica: the case's own for replica 0, so that the first of N is the case without replicas; a case with
// replica r's seed and no replicas is replica r. At most 2^63 - 1, what a case file can hold.
std::uint64_t replica_seed(std::uint64_t seed, int replica);

// "grains 'mix'", and with more than one replica "grains 'mix' of replica 3".
std::string name_of(Case const& c, GrainEntry const& entry);

}  // namespace scree
