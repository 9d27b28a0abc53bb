// file_hash.cpp: a short name for the content of a file.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/file_hash.h"

#include <cstdint>
#include <cstdio>
#include <fstream>

namespace scree {

std::string file_hash(std::filesystem::path const& file) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  std::ifstream in(file, std::ios::binary);
  for (char c; in.get(c);) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  char text[32];
  std::snprintf(text, sizeof(text), "fnv1a:%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace scree
