// ply_header.h: the header of a PLY file: its format, elements and their properties (Turk 1994).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
int size_of(PlyType type);  // [bytes]

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  // of the value, or of a list's items
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  // of a list's length
};

struct PlyElement {
  std::string name;
  int count = 0;  // rows
  std::vector<PlyProperty> property;

  int find(char const* property_name) const;  // -1: none of that name
};

struct PlyHeader {
  bool ascii = false;  // else binary, little-endian
  std::vector<PlyElement> element;
  std::size_t body = 0;  // offset of the first byte after the header
  int lines = 0;         // of the header

  PlyElement const* find(char const* element_name) const;  // null: none
};

// Throws std::runtime_error "<file>:<line>: ...", also for big-endian files.
PlyHeader parse_ply_header(std::filesystem::path const& file, std::string const& bytes);

}  // namespace scree
