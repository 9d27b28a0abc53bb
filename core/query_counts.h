// query_counts.h: how many queries a run made, and how many it could do without, and why.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace scree {

// Sums over steps. Of `nodes` a brute force would have evaluated all; nodes - listed were left out of the lists because
// they were too far away when these were made (`blocks` queries, one for 32 nodes, said so where boxes and balls did
// not); listed - due could not have come inside since their last query.
struct QueryCounts {
  std::int64_t nodes = 0;   // of both bodies of all near pairs
  std::int64_t listed = 0;  // in a list
  std::int64_t due = 0;     // evaluated
  std::int64_t again = 0;   // evaluated once more, for their gradient: they had just come inside
  std::int64_t blocks = 0;  // evaluated to make lists
  double flop = 0;          // useful operations of networks evaluated by the host

  std::int64_t made() const { return due + again + blocks; }

  friend QueryCounts operator-(QueryCounts a, QueryCounts const& b) {
    a.nodes -= b.nodes, a.listed -= b.listed, a.due -= b.due, a.again -= b.again, a.blocks -= b.blocks;
    a.flop -= b.flop;
    return a;
  }
};

}  // namespace scree
