// profile.cpp: see profile.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/profile.h"

#include <cstring>

namespace scree {

void Profile::add(char const* name, double seconds, std::int64_t items) {
  std::size_t i = 0;
  while (i < keys_.size() && keys_[i] != name && std::strcmp(keys_[i], name) != 0) ++i;
  if (i == keys_.size() || i >= entries_.size()) {
    keys_.resize(entries_.size());
    i = entries_.size();
    keys_.push_back(name);
    entries_.push_back({name, 0, 0, 0});
  }
  entries_[i].seconds += seconds;
  entries_[i].calls += 1;
  entries_[i].items += items;
}

}  // namespace scree
