// case_reader.cpp: see case_reader.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "core/case_keys.h"
#include "core/nearest_name.h"
#include "core/toml_text.h"

namespace scree {
namespace {

bool contains(std::vector<std::string> const& list, std::string const& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool is_number(CaseNode const& node) {
  return node.kind == CaseNode::Kind::integer || node.kind == CaseNode::Kind::real;
}

// Values as the reference writes them.
std::string written(double v) { return fmt::format("{}", v); }
std::string written(std::int64_t v) { return fmt::format("{}", v); }
std::string written(bool v) { return v ? "true" : "false"; }
std::string written(Vec3 v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }
std::string written(std::string const& v) { return v; }
template <class T>
std::string written(std::optional<T> const& v) {
  return v ? written(*v) : "none";
}
template <class T>
std::string written(std::vector<T> const&) {
  return "none";
}

}  // namespace

template <class T>
void CaseReader::note(std::string const& key, Need need, char const* type, T const& out) {
  if (problems_->asked)
    problems_->asked->push_back({without_indices(path_of(key)), kind_, type, written(out), need == Need::required});
}

CaseProblems::Place CaseProblems::place_of(std::string const& key) const {
  std::string path = key;
  while (!path.empty()) {
    auto const found = place.find(path);
    if (found != place.end()) return found->second;
    std::size_t const dot = path.rfind('.');
    path = dot == std::string::npos ? "" : path.substr(0, dot);
  }
  auto const root = place.find("");
  return root == place.end() ? Place{} : root->second;
}

CaseReader::CaseReader(CaseNode const& table, std::string path, CaseProblems& problems)
    : node_(&table), path_(std::move(path)), problems_(&problems) {
  problems_->place[path_] = {table.where, table.line};
}

CaseNode const* CaseReader::present(std::string const& key, Need need) {
  if (problems_->documented && !problems_->documented(path_of(key))) return nullptr;  // finish() refuses it
  known_.push_back(key);
  CaseNode const* const node = node_->find(key);
  if (node)
    problems_->place[path_of(key)] = {node->where, node->line};
  else if (need == Need::required)
    report(key, "is missing and has no default");
  return node;
}

bool CaseReader::wrong_type(std::string const& key, CaseNode const& node, std::string const& wanted) {
  report(key, fmt::format("must be {}, not {}", wanted, to_string(node.kind)));
  return false;
}

bool CaseReader::read_number(std::string const& key, double& out, Need need) {
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (!is_number(*node)) return wrong_type(key, *node, "a number");
  out = node->real;
  return true;
}

bool CaseReader::number(std::string const& key, double& out, Need need) {
  note(key, need, "number", out);
  return read_number(key, out, need);
}

bool CaseReader::number(std::string const& key, std::optional<double>& out, Need need) {
  note(key, need, "number", out);
  double value = 0;
  if (!read_number(key, value, need)) return false;
  out = value;
  return true;
}

bool CaseReader::read_integer(std::string const& key, std::int64_t& out, Need need) {
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (node->kind != CaseNode::Kind::integer) return wrong_type(key, *node, "a whole number");
  out = node->integer;
  return true;
}

bool CaseReader::integer(std::string const& key, std::int64_t& out, Need need) {
  note(key, need, "whole number", out);
  return read_integer(key, out, need);
}

bool CaseReader::integer(std::string const& key, int& out, Need need) {
  note(key, need, "whole number", std::int64_t{out});
  std::int64_t value = 0;
  if (!read_integer(key, value, need)) return false;
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    report(key, fmt::format("{} is beyond what a count can be ({})", value, std::numeric_limits<int>::max()));
    return false;
  }
  out = static_cast<int>(value);
  return true;
}

bool CaseReader::boolean(std::string const& key, bool& out, Need need) {
  note(key, need, "true or false", out);
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (node->kind != CaseNode::Kind::boolean) return wrong_type(key, *node, "true or false");
  out = node->boolean;
  return true;
}

bool CaseReader::read_text(std::string const& key, std::string& out, Need need) {
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (node->kind != CaseNode::Kind::string) return wrong_type(key, *node, "a string");
  out = node->text;
  if (key == "kind") kind_ = out;
  return true;
}

bool CaseReader::text(std::string const& key, std::string& out, Need need) {
  note(key, need, "string", out);
  return read_text(key, out, need);
}

bool CaseReader::texts(std::string const& key, std::vector<std::string>& out, Need need) {
  note(key, need, "list of strings", out);
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (node->kind != CaseNode::Kind::array) return wrong_type(key, *node, "a list of strings");
  std::vector<std::string> read;
  for (CaseNode const& element : node->element) {
    if (element.kind != CaseNode::Kind::string) return wrong_type(key, element, "a list of strings only");
    read.push_back(element.text);
  }
  out = std::move(read);
  return true;
}

bool CaseReader::numbers(std::string const& key, CaseNode const& node, int count, double* out,
                         std::string const& wanted) {
  if (node.kind != CaseNode::Kind::array) return wrong_type(key, node, wanted);
  if (static_cast<int>(node.element.size()) != count) {
    report(key, fmt::format("must be {}, not {} values", wanted, node.element.size()));
    return false;
  }
  for (int i = 0; i < count; ++i) {
    if (!is_number(node.element[i])) return wrong_type(key, node.element[i], wanted);
    out[i] = node.element[i].real;
  }
  return true;
}

bool CaseReader::vector(std::string const& key, Vec3& out, Need need) {
  note(key, need, "[x, y, z]", out);
  CaseNode const* const node = present(key, need);
  double v[3];
  if (!node || !numbers(key, *node, 3, v, "three numbers [x, y, z]")) return false;
  out = {v[0], v[1], v[2]};
  return true;
}

bool CaseReader::interval(std::string const& key, double& low, double& high, Need need) {
  note(key, need, "[low, high]", fmt::format("[{}, {}]", low, high));
  CaseNode const* const node = present(key, need);
  double v[2];
  if (!node || !numbers(key, *node, 2, v, "two numbers [low, high]")) return false;
  low = v[0], high = v[1];
  return true;
}

bool CaseReader::numbers(std::string const& key, std::vector<double>& out, Need need) {
  note(key, need, "list of numbers", out);
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  bool const fits =
      node->kind == CaseNode::Kind::array && std::all_of(node->element.begin(), node->element.end(), is_number);
  if (!fits) return wrong_type(key, *node, "a list of numbers");
  out.clear();
  for (CaseNode const& element : node->element) out.push_back(element.real);
  return true;
}

bool CaseReader::vectors(std::string const& key, std::vector<Vec3>& out, Need need) {
  note(key, need, "list of [x, y, z]", out);
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (node->kind != CaseNode::Kind::array) return wrong_type(key, *node, "a list of [x, y, z]");
  std::vector<Vec3> read;
  for (CaseNode const& element : node->element) {
    double v[3];
    if (!numbers(key, element, 3, v, "a list of [x, y, z]")) return false;
    read.push_back({v[0], v[1], v[2]});
  }
  out = std::move(read);
  return true;
}

bool CaseReader::quaternions(std::string const& key, std::vector<Quat>& out, Need need) {
  note(key, need, "list of [w, x, y, z]", out);
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (node->kind != CaseNode::Kind::array) return wrong_type(key, *node, "a list of [w, x, y, z]");
  std::vector<Quat> read;
  for (CaseNode const& element : node->element) {
    double q[4];
    if (!numbers(key, element, 4, q, "a list of [w, x, y, z]")) return false;
    read.push_back({q[0], q[1], q[2], q[3]});
  }
  out = std::move(read);
  return true;
}

bool CaseReader::pairs(std::string const& key, std::vector<double>& first, std::vector<double>& second, Need need) {
  note(key, need, "list of [a, b]", first);
  CaseNode const* const node = present(key, need);
  if (!node) return false;
  if (node->kind != CaseNode::Kind::array) return wrong_type(key, *node, "a list of [a, b]");
  std::vector<double> a, b;
  for (CaseNode const& element : node->element) {
    double v[2];
    if (!numbers(key, element, 2, v, "a list of [a, b]")) return false;
    a.push_back(v[0]), b.push_back(v[1]);
  }
  first = std::move(a), second = std::move(b);
  return true;
}

int CaseReader::choice_index(std::string const& key, std::vector<std::string> const& words,
                             std::vector<std::string> const& later, Need need, std::string const& fallback) {
  note(key, need, fmt::format("\"{}\"", fmt::join(words, "\", \"")).c_str(), toml_quoted(fallback));
  std::string word;
  if (!read_text(key, word, need)) return -1;
  auto const found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<int>(found - words.begin());
  if (contains(later, word))
    report(key, fmt::format("'{}' is not supported in this version; supported: {}", word, fmt::join(words, ", ")));
  else
    report(key, fmt::format("'{}' is unknown{}; allowed: {}", word, did_you_mean(word, words), fmt::join(words, ", ")));
  return -1;
}

std::optional<CaseReader> CaseReader::table(std::string const& key, Need need) {
  note(key, need, "table", std::string("none"));
  CaseNode const* const node = present(key, need);
  if (!node) return std::nullopt;
  if (node->kind != CaseNode::Kind::table) {
    wrong_type(key, *node, "a table");
    return std::nullopt;
  }
  return CaseReader(*node, path_of(key), *problems_);
}

std::vector<CaseReader> CaseReader::tables(std::string const& key) {
  note(key, Need::optional, "list of tables", std::string("none"));
  std::vector<CaseReader> readers;
  CaseNode const* const node = present(key);
  if (!node) return readers;
  if (node->kind != CaseNode::Kind::array) {
    wrong_type(key, *node, fmt::format("a list of tables, written [[{}]]", key));
    return readers;
  }
  for (std::size_t i = 0; i < node->element.size(); ++i) {
    if (node->element[i].kind != CaseNode::Kind::table) {
      wrong_type(key, node->element[i], fmt::format("a list of tables, written [[{}]]", key));
      return {};
    }
    readers.emplace_back(node->element[i], fmt::format("{}.{}", path_of(key), i), *problems_);
  }
  return readers;
}

void CaseReader::unsupported(std::vector<std::string> const& keys) {
  later_.insert(later_.end(), keys.begin(), keys.end());
}

void CaseReader::finish() {
  std::vector<std::string> supported = known_;
  std::sort(supported.begin(), supported.end());
  for (std::size_t i = 0; i < node_->key.size(); ++i) {
    std::string const& key = node_->key[i];
    CaseNode const& node = node_->element[i];
    if (contains(known_, key)) continue;
    problems_->place[path_of(key)] = {node.where, node.line};
    std::string const verdict =
        contains(later_, key) ? "is not supported in this version" : "is an unknown key" + did_you_mean(key, known_);
    report(key, fmt::format("{}; supported here: {}", verdict, fmt::join(supported, ", ")));
  }
}

}  // namespace scree
