// ply_header.cpp: see ply_header.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/ply_header.h"

#include <charconv>
#include <map>
#include <string_view>

#include "shapes/text_lines.h"

namespace scree {
namespace {

using Words = std::vector<std::string_view>;

PlyType type_of(std::filesystem::path const& file, int line, std::string_view word) {
  static std::map<std::string_view, PlyType> const known{
      {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
      {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
      {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
      {"float64", PlyType::float64}};
  auto const at = known.find(word);
  if (at == known.end()) fail_file(file, line, "unknown PLY type: " + std::string(word));
  return at->second;
}

PlyElement parse_element(std::filesystem::path const& file, int line, Words const& w) {
  if (w.size() != 3) fail_file(file, line, "write: element NAME COUNT");
  PlyElement element;
  element.name = w[1];
  auto const [stop, error] = std::from_chars(w[2].data(), w[2].data() + w[2].size(), element.count);
  if (error != std::errc() || stop != w[2].data() + w[2].size() || element.count < 0 || element.count > 1 << 28)
    fail_file(file, line, "not a count between 0 and 2^28: " + std::string(w[2]));
  return element;
}

PlyProperty parse_property(std::filesystem::path const& file, int line, Words const& w) {
  PlyProperty p;
  p.is_list = w.size() > 1 && w[1] == "list";
  if (w.size() != (p.is_list ? 5 : 3))
    fail_file(file, line, "write: property TYPE NAME, or property list TYPE TYPE NAME");
  p.name = w.back();
  p.type = type_of(file, line, w[w.size() - 2]);
  if (p.is_list) p.count_type = type_of(file, line, w[2]);
  if (p.is_list && p.count_type >= PlyType::float32) fail_file(file, line, "the length of a list must be an integer");
  return p;
}

void parse_format(std::filesystem::path const& file, int line, Words const& w, PlyHeader& header) {
  if (w.size() != 3 || w[2] != "1.0") fail_file(file, line, "write: format FORMAT 1.0");
  if (w[1] == "binary_big_endian")
    fail_file(file, line, "binary_big_endian is not read; convert it to ascii or binary_little_endian");
  if (w[1] != "ascii" && w[1] != "binary_little_endian")
    fail_file(file, line, "unknown PLY format: " + std::string(w[1]));
  header.ascii = w[1] == "ascii";
}

}  // namespace

int size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

int PlyElement::find(char const* property_name) const {
  for (std::size_t i = 0; i < property.size(); ++i)
    if (property[i].name == property_name) return static_cast<int>(i);
  return -1;
}

PlyElement const* PlyHeader::find(char const* element_name) const {
  for (PlyElement const& e : element)
    if (e.name == element_name) return &e;
  return nullptr;
}

PlyHeader parse_ply_header(std::filesystem::path const& file, std::string const& bytes) {
  PlyHeader header;
  bool has_format = false;
  while (true) {
    std::size_t const end = bytes.find('\n', header.body);
    if (end == std::string::npos) fail_file(file, header.lines + 1, "the PLY header has no end_header");
    Words const w = words(std::string_view(bytes).substr(header.body, end - header.body));
    int const line = ++header.lines;
    header.body = end + 1;
    if (line == 1) {
      if (w.size() != 1 || w[0] != "ply") fail_file(file, line, "a PLY file begins with: ply");
    } else if (w.empty() || w[0] == "comment" || w[0] == "obj_info") {
      continue;
    } else if (w[0] == "format") {
      parse_format(file, line, w, header);
      has_format = true;
    } else if (w[0] == "element") {
      header.element.push_back(parse_element(file, line, w));
    } else if (w[0] == "property") {
      if (header.element.empty()) fail_file(file, line, "a property before the first element");
      header.element.back().property.push_back(parse_property(file, line, w));
    } else if (w[0] == "end_header") {
      // Rows of nothing take no bytes: a damaged count of them would take hours.
      for (PlyElement const& e : header.element)
        if (e.count > 0 && e.property.empty()) fail_file(file, line, "element '" + e.name + "' has no properties");
      if (!has_format) fail_file(file, line, "the PLY header names no format");
      return header;
    } else {
      fail_file(file, line, "unknown word in the PLY header: " + std::string(w[0]));
    }
  }
}

}  // namespace scree
