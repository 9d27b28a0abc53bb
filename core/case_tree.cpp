// case_tree.cpp: see case_tree.h. The one file that sees toml++.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_tree.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/case.h"
#include "core/nearest_name.h"

namespace scree {
namespace {

// `file` empty: the node comes from --set.
CaseNode convert(toml::node const& node, std::string const& file) {
  CaseNode out;
  out.line = file.empty() ? 0 : static_cast<int>(node.source().begin.line);
  out.where = file.empty() ? "--set" : fmt::format("{}:{}", file, out.line);
  if (auto const* table = node.as_table()) {
    out.kind = CaseNode::Kind::table;
    for (auto const& [key, value] : *table) {
      out.key.emplace_back(key.str());
      out.element.push_back(convert(value, file));
    }
  } else if (auto const* array = node.as_array()) {
    out.kind = CaseNode::Kind::array;
    for (toml::node const& value : *array) out.element.push_back(convert(value, file));
  } else if (auto const* text = node.as_string()) {
    out.kind = CaseNode::Kind::string;
    out.text = text->get();
  } else if (auto const* integer = node.as_integer()) {
    out.kind = CaseNode::Kind::integer;
    out.integer = integer->get();
    out.real = static_cast<double>(out.integer);
  } else if (auto const* real = node.as_floating_point()) {
    out.kind = CaseNode::Kind::real;
    out.real = real->get();
  } else if (auto const* boolean = node.as_boolean()) {
    out.kind = CaseNode::Kind::boolean;
    out.boolean = boolean->get();
  } else {
    out.kind = CaseNode::Kind::date;
  }
  return out;
}

// The right side of --set: TOML, or else the bare text as a string.
CaseNode override_value(std::string const& text) {
  CaseNode out;
  try {
    toml::table const table = toml::parse("value = " + text);
    if (table.size() == 1) return convert(*table.get("value"), "");
  } catch (toml::parse_error const&) {
    // not TOML: a bare word such as a name or a path
  }
  out.kind = CaseNode::Kind::string;
  out.where = "--set";
  out.text = text;
  return out;
}

std::vector<std::string> entry_names(CaseNode const& array) {
  std::vector<std::string> names;
  for (CaseNode const& entry : array.element) {
    CaseNode const* const name = entry.kind == CaseNode::Kind::table ? entry.find("name") : nullptr;
    names.push_back(name && name->kind == CaseNode::Kind::string ? name->text : "");
  }
  return names;
}

// Entry of a list by index or name; -1: none.
int entry_index(CaseNode const& array, std::string const& key) {
  std::vector<std::string> const names = entry_names(array);
  auto const found = std::find(names.begin(), names.end(), key);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  int index = -1;
  auto const [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  bool const valid = error == std::errc() && end == key.data() + key.size() && index >= 0;
  return valid && index < static_cast<int>(names.size()) ? index : -1;
}

CaseNode* descend(CaseNode& node, std::string const& key, std::string const& walked, std::string const& assignment,
                  std::vector<std::string>& problems) {
  if (node.kind == CaseNode::Kind::array) {
    int const index = entry_index(node, key);
    if (index >= 0) return &node.element[index];
    problems.push_back(fmt::format("--set {}: '{}' has no entry '{}'{}; it has {} (0 ... by index, or by name)",
                                   assignment, walked, key, did_you_mean(key, entry_names(node)), node.element.size()));
    return nullptr;
  }
  if (node.kind == CaseNode::Kind::table) {
    if (CaseNode* const next = node.find(key)) return next;
    CaseNode made;
    made.where = "--set";
    node.key.push_back(key);
    node.element.push_back(made);
    return &node.element.back();
  }
  problems.push_back(fmt::format("--set {}: '{}' is {} and has no keys", assignment, walked, to_string(node.kind)));
  return nullptr;
}

void remove(CaseNode& table, std::string const& name) {
  auto const found = std::find(table.key.begin(), table.key.end(), name);
  if (found == table.key.end()) return;
  table.element.erase(table.element.begin() + (found - table.key.begin()));
  table.key.erase(found);
}

std::vector<std::string> split(std::string const& path) {
  std::vector<std::string> parts(1);
  for (char const c : path) {
    if (c == '.')
      parts.emplace_back();
    else if (c != ' ')
      parts.back() += c;
  }
  return parts;
}

}  // namespace

CaseNode const* CaseNode::find(std::string const& name) const {
  auto const found = std::find(key.begin(), key.end(), name);
  return found == key.end() ? nullptr : &element[static_cast<std::size_t>(found - key.begin())];
}

CaseNode* CaseNode::find(std::string const& name) { return const_cast<CaseNode*>(std::as_const(*this).find(name)); }

char const* to_string(CaseNode::Kind kind) {
  switch (kind) {
    case CaseNode::Kind::table:
      return "a table";
    case CaseNode::Kind::array:
      return "a list";
    case CaseNode::Kind::string:
      return "a string";
    case CaseNode::Kind::integer:
      return "a whole number";
    case CaseNode::Kind::real:
      return "a number";
    case CaseNode::Kind::boolean:
      return "true or false";
    case CaseNode::Kind::date:
      return "a date or time";
  }
  throw std::logic_error("CaseNode::Kind out of range");
}

CaseNode parse_case_file(std::filesystem::path const& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw InputError({fmt::format("{}: no such case file", file.string())});
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, error))
    throw InputError({fmt::format("{}: cannot be read as a case file", file.string())});
  return parse_case_text({std::istreambuf_iterator<char>(stream), {}}, file.string());
}

CaseNode parse_case_text(std::string const& text, std::string const& where) {
  try {
    return convert(toml::parse(std::string_view(text)), where);
  } catch (toml::parse_error const& problem) {
    toml::source_position const at = problem.source().begin;
    throw InputError({fmt::format("{}:{}:{}: TOML syntax: {}", where, at.line, at.column, problem.description())});
  }
}

void apply_override(CaseNode& root, std::string const& assignment, std::vector<std::string>& problems) {
  std::size_t const equals = assignment.find('=');
  std::vector<std::string> const parts = split(assignment.substr(0, equals));
  if (equals == std::string::npos || std::find(parts.begin(), parts.end(), "") != parts.end()) {
    problems.push_back(fmt::format("--set {}: write it as key=value, e.g. --set time.end=2", assignment));
    return;
  }
  CaseNode* node = &root;
  std::string walked = "the case";
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    node = descend(*node, parts[i], walked, assignment, problems);
    if (!node) return;
    walked = i == 0 ? parts[i] : walked + "." + parts[i];
  }
  std::string const value = assignment.substr(equals + 1);
  bool const removes = value.find_first_not_of(' ') == std::string::npos;
  if (removes && node->kind == CaseNode::Kind::table) {
    remove(*node, parts.back());
    return;
  }
  CaseNode* const leaf = descend(*node, parts.back(), walked, assignment, problems);
  if (leaf) *leaf = override_value(value);
}

}  // namespace scree
