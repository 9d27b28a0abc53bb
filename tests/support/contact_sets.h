// contact_sets.h: the contact sets of a run that uses node lists against those of one that asks every node.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "core/simulation.h"
#include "core/simulation_impl.h"

namespace scree::testing {

// (name, calls, items) of every launch so far.
inline std::vector<std::tuple<std::string, std::int64_t, std::int64_t>> launches(Simulation const& s) {
  std::vector<std::tuple<std::string, std::int64_t, std::int64_t>> out;
  for (Profile::Entry const& e : s.profile().entries()) out.push_back({e.name, e.calls, e.items});
  return out;
}

// (carrier, partner, node) of every node in contact, sorted.
inline std::vector<std::tuple<int, int, int>> active_nodes(Simulation& s) {
  std::vector<std::tuple<int, int, int>> found;
  auto const& w = s.impl().work;
  for (std::size_t side = 0; side < w.gather.lists.side.size(); ++side)
    for (int i = w.active.first[side]; i < w.active.first[side + 1]; ++i)
      found.push_back({w.gather.lists.side[side].carrier, w.gather.lists.side[side].partner, w.active.node[i]});
  std::sort(found.begin(), found.end());
  return found;
}

// Runs both to their end and compares them at every step. More than `least` contacts must have been seen, summed over
// the steps, or the comparison says nothing.
inline void expect_same_contact_sets(Simulation& lists, Simulation& brute, std::size_t least) {
  std::size_t contacts = 0;
  while (lists.state() == RunState::running) {
    lists.step();
    brute.step();
    auto const found = active_nodes(lists);
    ASSERT_EQ(found, active_nodes(brute)) << "at step " << lists.steps();
    contacts += found.size();
  }
  EXPECT_GT(contacts, least);
  EXPECT_EQ(lists.frame().position, brute.frame().position);
}

}  // namespace scree::testing
