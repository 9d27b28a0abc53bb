// same_state.h: two states bit by bit: no tolerance, NaN equals itself, 0 and -0 differ.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "core/state_members.h"

namespace scree::testing {

// The bytes of every member by name.
inline std::map<std::string, std::string> bytes_of(State const& state) {
  std::map<std::string, std::string> out;
  auto const put = [](std::string& to, auto const& v) { to.append(reinterpret_cast<char const*>(&v), sizeof(v)); };
  for_each_member(state, [&]<class T>(char const* name, T const& member) {
    std::string& to = out[name];
    if constexpr (std::is_same_v<T, std::vector<Insertion>>) {
      for (Insertion const& in : member) {  // it has padding
        put(to, in.done), put(to, in.random), put(to, in.blocked_since);
        put(to, in.blocked_times), put(to, in.blocked_seconds);
      }
    } else if constexpr (std::is_same_v<T, std::vector<Measurement>>) {
      for (Measurement const& m : member) {
        put(to, m.next), put(to, m.last_time), put(to, m.memory.size());
        for (double const v : m.memory) put(to, v);
        for (Moments const& k : m.moments) put(to, k);
      }
    } else if constexpr (std::is_arithmetic_v<T>) {
      put(to, member);
    } else {
      for (auto const& v : member) put(to, v);
    }
  });
  return out;
}

// Names of the members that differ; empty: the same bits.
inline std::string differences(State const& a, State const& b) {
  std::map<std::string, std::string> const x = bytes_of(a), y = bytes_of(b);
  std::string out;
  for (auto const& [name, bytes] : x)
    if (bytes != y.at(name)) out += name + " ";
  return out;
}

inline std::size_t hash_of(State const& state) {
  std::string all;
  for (auto const& [name, bytes] : bytes_of(state)) all += name + bytes;
  return std::hash<std::string>{}(all);
}

}  // namespace scree::testing
