// content_cache.h: what takes long to make, kept between runs under a hash of everything it was made from.
// Folder: $SCREE_CACHE (empty: keep nothing), else $XDG_CACHE_HOME/scree, else ~/.cache/scree. A cache that cannot be
// used costs time only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "shapes/shape.h"

namespace scree {

// FNV-1a, 64 bits (Fowler, Noll, Vo).
class ContentHash {
 public:
  template <class T>
  ContentHash& add(T const& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);  // padding must not count
    bytes(&value, sizeof(value));
    return *this;
  }
  ContentHash& add(Vec3 v) { return add(v.x).add(v.y).add(v.z); }
  ContentHash& add(std::string const& s) {
    bytes(s.data(), s.size());
    return add(s.size());
  }
  template <class T>
  ContentHash& add(std::vector<T> const& list) {
    for (T const& value : list) add(value);
    return add(list.size());
  }
  // All that phi of a shape depends on; for networks also the instruction set that evaluates them.
  ContentHash& add_phi(Library const& library, Shape const& shape);
  std::string digits() const;  // 16, hexadecimal

 private:
  void bytes(void const* from, std::size_t count);
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

// Where things are kept; empty: nowhere.
std::filesystem::path cache_folder();

// The library kept under this key. A damaged file is a note, and as good as none.
std::optional<Library> read_cached(std::string const& key, std::vector<std::string>& notes);

// Keeps it, atomically, so that runs may share the folder. `what`, plural, is what a note says is not kept: where the
// folder cannot be written or the environment names none.
void keep_cached(std::string const& key, Library const& library, std::string const& what,
                 std::vector<std::string>& notes);

}  // namespace scree
