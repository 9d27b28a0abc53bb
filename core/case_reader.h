// case_reader.h: typed access to the tables of a case file; collects every problem with its place.
// A key that is asked for is known; finish() reports the others with the nearest known key.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/case_tree.h"
#include "kernels/base/vec.h"

namespace scree {

struct CaseProblem {
  std::string key;  // dotted path, list entries by index: "grains.0.diameter"
  std::string text;
};

// One key that was asked for, as the code that reads it has it: the reference is made from these.
struct AskedKey {
  std::string path;      // without the indices of list entries
  std::string kind;      // of the table, where it was read before; "": keys that all kinds have
  std::string type;      // "number", "[x, y, z]", ...; "": only looked for
  std::string fallback;  // what stays without it, as the case file would write it
  bool required = false;
};

// Problems of one case, and where each key was written.
struct CaseProblems {
  struct Place {
    std::string where;
    int line = 0;
  };
  std::map<std::string, Place> place;  // of every key that was present
  std::vector<CaseProblem> found;
  bool (*documented)(std::string const& path) = nullptr;  // set: keys that it does not know are unknown
  std::vector<AskedKey>* asked = nullptr;                 // set: every key asked for is noted here

  void add(std::string key, std::string text) { found.push_back({std::move(key), std::move(text)}); }
  Place place_of(std::string const& key) const;  // of the key, or of the nearest table around it
};

enum class Need { optional, required };

// One table. Getters leave `out` untouched and return false when the key is absent or wrong (then reported).
class CaseReader {
 public:
  CaseReader(CaseNode const& table, std::string path, CaseProblems& problems);

  bool number(std::string const& key, double& out, Need need = Need::optional);
  bool number(std::string const& key, std::optional<double>& out, Need need = Need::optional);
  bool integer(std::string const& key, std::int64_t& out, Need need = Need::optional);
  bool integer(std::string const& key, int& out, Need need = Need::optional);
  bool boolean(std::string const& key, bool& out, Need need = Need::optional);
  bool text(std::string const& key, std::string& out, Need need = Need::optional);
  bool texts(std::string const& key, std::vector<std::string>& out, Need need = Need::optional);
  bool vector(std::string const& key, Vec3& out, Need need = Need::optional);
  bool interval(std::string const& key, double& low, double& high, Need need = Need::optional);  // [low, high]
  bool numbers(std::string const& key, std::vector<double>& out, Need need = Need::optional);
  bool vectors(std::string const& key, std::vector<Vec3>& out, Need need = Need::optional);
  bool quaternions(std::string const& key, std::vector<Quat>& out, Need need = Need::optional);
  // [[a, b], ...]: the first and the second numbers.
  bool pairs(std::string const& key, std::vector<double>& first, std::vector<double>& second,
             Need need = Need::optional);

  // A word out of `choices`; `later` are words of the format that this version does not support.
  template <class T>
  bool choice(std::string const& key, T& out, std::vector<std::pair<std::string, T>> const& choices,
              std::vector<std::string> const& later = {}, Need need = Need::optional) {
    std::vector<std::string> words;
    std::string fallback;
    for (auto const& [word, value] : choices) {
      words.push_back(word);
      if (value == out) fallback = word;
    }
    int const index = choice_index(key, words, later, need, fallback);
    if (index < 0) return false;
    out = choices[index].second;
    return true;
  }

  std::optional<CaseReader> table(std::string const& key, Need need = Need::optional);
  std::vector<CaseReader> tables(std::string const& key);  // [[key]]; empty when absent

  CaseNode const* present(std::string const& key, Need need = Need::optional);  // makes the key known
  void unsupported(std::vector<std::string> const& keys);  // keys of the format that this version does not support
  void finish();                                           // report unknown keys

  std::string path_of(std::string const& key) const { return path_.empty() ? key : path_ + "." + key; }
  void report(std::string const& key, std::string text) { problems_->add(path_of(key), std::move(text)); }

 private:
  int choice_index(std::string const& key, std::vector<std::string> const& words, std::vector<std::string> const& later,
                   Need need, std::string const& fallback);
  // For the reference, where one is being made: what is asked for. Before anything is read into `out`.
  template <class T>
  void note(std::string const& key, Need need, char const* type, T const& out);
  bool wrong_type(std::string const& key, CaseNode const& node, std::string const& wanted);
  bool numbers(std::string const& key, CaseNode const& node, int count, double* out, std::string const& wanted);
  bool read_number(std::string const& key, double& out, Need need);
  bool read_integer(std::string const& key, std::int64_t& out, Need need);
  bool read_text(std::string const& key, std::string& out, Need need);

  CaseNode const* node_;
  std::string path_;
  std::string kind_;  // value of the key `kind`, once it is read
  CaseProblems* problems_;
  std::vector<std::string> known_;
  std::vector<std::string> later_;
};

}  // namespace scree
