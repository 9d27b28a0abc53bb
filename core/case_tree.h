// case_tree.h: a case file as a plain tree that remembers where every value was written.
// Parsing and --set live here, so that one source file sees the TOML library.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

struct CaseNode {
  enum class Kind { table, array, string, integer, real, boolean, date } kind = Kind::table;
  std::string where;              // "file:line" or "--set"
  int line = 0;                   // 0: from --set
  std::vector<CaseNode> element;  // of an array; the values of a table, in order of appearance
  std::vector<std::string> key;   // of a table: key[i] names element[i]
  std::string text;               // string
  std::int64_t integer = 0;
  double real = 0;  // also set for integers
  bool boolean = false;

  CaseNode const* find(std::string const& name) const;  // member of a table; nullptr: absent
  CaseNode* find(std::string const& name);
};

char const* to_string(CaseNode::Kind kind);  // "a table", "a string" ...

// Throws InputError: a missing or unreadable file; a syntax error, alone, as "file:line:column".
CaseNode parse_case_file(std::filesystem::path const& file);
CaseNode parse_case_text(std::string const& text, std::string const& where);  // where: its file, for messages

// Apply "dotted.path=value". The value is TOML ("2", "[0, 0, 1]", "\"text\""); what is not TOML is taken as a string;
// an empty value removes the key. Entries of a list of tables are named by their index or their `name`.
// Missing tables on the way are made. Problems are appended, one line each.
void apply_override(CaseNode& root, std::string const& assignment, std::vector<std::string>& problems);

}  // namespace scree
