// case_reference.cpp: see case_reference.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/case_keys.h"
#include "core/case_text.h"
#include "core/measure_kinds.h"

namespace scree {
namespace {

// Each table and each kind once: the parser asks for all their keys whether they are there or not.
char constexpr each_table[] = R"(
case = {}
time = { step = 1, settle = {} }
gravity = {}
drag = {}
damping = {}
force = [{}]
delete = [{ kind = "box" }, { kind = "plane" }]
library = [{}]
material = [{}]
contact = [{ normal = {}, damping = {}, rolling = {}, cohesion = {} }]
grains = [
  { nodes = 1, diameter = 1, sample = {}, interpolate = { t = 1 }, insert = { kind = "lattice" } },
  { diameter = [1, 1], interpolate = { t = [0, 1] }, insert = { kind = "random" } },
  { insert = { kind = "rate" } }, { insert = { kind = "list" } }, { insert = { kind = "file" } },
]
wall = [
  { kind = "plane", motion = { kind = "rotation" } }, { kind = "box", motion = { kind = "translation" } },
  { kind = "cylinder", motion = { kind = "rotation", time = [] } },
  { kind = "cone", motion = { kind = "translation", time = [] } },
  { kind = "capsule" }, { kind = "mesh" }, { kind = "terrain" },
]
accuracy = {}
device = {}
output = {}
checkpoint = {}
limits = {}
relax = {}
)";

void add_once(std::vector<std::string>& list, std::string const& word) {
  if (!word.empty() && std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
}

// All calls that ask for one path, taken together.
struct Row {
  std::vector<std::string> types, kinds;
  std::string fallback;
  bool always = false;    // asked for whatever the kind
  bool required = false;  // by some call
};

Row row_of(std::string const& path, std::vector<AskedKey> const& asked) {
  Row row;
  for (AskedKey const& a : asked) {
    if (a.path != path || a.type.empty()) continue;
    add_once(row.types, a.type);
    add_once(row.kinds, a.kind);
    row.always = row.always || a.kind.empty();
    row.required = row.required || a.required;
    if (row.fallback.empty()) row.fallback = a.fallback;
  }
  return row;
}

// The kinds that the table of `path` can have.
std::vector<std::string> kinds_beside(std::string const& path, std::vector<AskedKey> const& asked) {
  std::string const table = path.substr(0, path.rfind('.') + 1);
  std::vector<std::string> kinds;
  for (AskedKey const& a : asked)
    if (a.path.starts_with(table) && a.path.find('.', table.size()) == std::string::npos) add_once(kinds, a.kind);
  return kinds;
}

std::string section_of(std::string const& path) { return path.substr(0, path.find('.')); }

std::string default_of(CaseKey const& key, Row const& row) {
  if (*key.fallback) return key.fallback;
  if (row.required) return "required";
  return row.fallback == "none" ? "none" : fmt::format("`{}`", row.fallback);
}

std::string type_of(Row const& row) {
  std::vector<std::string> types;
  for (std::string const& t : row.types) types.push_back(t.front() == '"' || t.front() == '[' ? "`" + t + "`" : t);
  return fmt::format("{}", fmt::join(types, " or "));
}

std::string line_of(CaseKey const& key, std::vector<AskedKey> const& asked) {
  Row const row = row_of(key.path, asked);
  std::string const name = std::string(key.path).substr(section_of(key.path).size() + 1);
  std::string meaning = key.meaning;
  bool const by_kind = !row.always && row.kinds != kinds_beside(key.path, asked);
  if (by_kind && section_of(key.path) != "measure")  // its kinds have a table of their own
    meaning = fmt::format("*{}:* {}", fmt::join(row.kinds, ", "), meaning);
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", name, type_of(row), default_of(key, row),
                     *key.range ? fmt::format("`{}`", key.range) : "", meaning);
}

std::string heading_of(CaseKey const& section, Row const& row, std::string const& default_text) {
  bool const list = row.types == std::vector<std::string>{"list of tables"};
  std::string const absent = row.required        ? " Required."
                             : *section.fallback ? " Without it: " + default_text + "."
                                                 : "";
  std::string text = section.meaning;
  if (!text.empty()) text = fmt::format("{:c}{}.", std::toupper(text[0]), text.substr(1));
  return fmt::format("\n### `{}{}{}`\n\n{}{}\n\n", list ? "[[" : "[", section.path, list ? "]]" : "]", text, absent);
}

std::string measure_table() {
  std::string out =
      "\n### Kinds of `[[measure]]`\n\nKeys in brackets may be left out. A region is `box` or `cylinder`.\n\n"
      "| kind | keys | quantities |\n|---|---|---|\n";
  for (MeasureKind const& kind : measure_kinds()) {
    std::vector<std::string> needed, allowed;
    for (char const* key : kind.required) needed.push_back(fmt::format("`{}`", key));
    for (char const* key : kind.optional) {
      std::string const name = key;
      if (name == "cylinder") continue;
      if (name == "box")
        (kind.region_needed ? needed : allowed).push_back("region");
      else
        allowed.push_back(fmt::format("`{}`", name));
    }
    std::string keys = fmt::format("{}", fmt::join(needed, ", "));
    if (!allowed.empty()) keys += fmt::format("{}[{}]", keys.empty() ? "" : ", ", fmt::join(allowed, ", "));
    out += fmt::format("| `{}` | {} | {} |\n", kind.name, keys, kind.meaning);
  }
  return out;
}

}  // namespace

std::vector<AskedKey> all_keys_asked() {
  std::string text = each_table;
  for (MeasureKind const& kind : measure_kinds())
    text += fmt::format("[[measure]]\nkind = \"{}\"\ncylinder = {{}}\n", kind.name);
  return keys_asked(text);
}

std::string case_reference(std::string const& prefix) {
  std::vector<AskedKey> const asked = all_keys_asked();
  std::string out, section;
  for (CaseKey const& key : case_keys()) {
    std::string const path = key.path, own = section_of(path);
    if (path == own || !path.starts_with(prefix)) continue;
    if (own != section) {
      CaseKey const& head = *find_case_key(own);
      out += heading_of(head, row_of(own, asked), head.fallback);
      out += "| key | type | default | range | meaning |\n|---|---|---|---|---|\n";
      section = own;
    }
    out += line_of(key, asked);
  }
  if (std::string("measure.kind").starts_with(prefix)) out += measure_table();
  return out.empty() ? out : out.substr(1);  // without the first blank line
}

}  // namespace scree
