// insert_file.cpp: see insert_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/insert_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "core/nearest_name.h"
#include "shapes/text_lines.h"
#include "shapes/whole_file.h"

namespace scree {
namespace {

std::array<char const*, 14> constexpr column_names{"x",  "y",  "z",  "qw", "qx", "qy", "qz",
                                                   "vx", "vy", "vz", "wx", "wy", "wz", "shape"};
struct Group {
  int first, count;
};
std::array<Group, 5> constexpr groups{{{0, 3}, {3, 4}, {7, 3}, {10, 3}, {13, 1}}};

// Where each column stands in the file; -1: it has none.
using Columns = std::array<int, column_names.size()>;

Columns read_columns(std::filesystem::path const& file, int line, std::vector<std::string_view> const& words) {
  std::vector<std::string> const known(column_names.begin(), column_names.end());
  Columns at;
  at.fill(-1);
  for (std::size_t w = 0; w < words.size(); ++w) {
    std::string const word(words[w]);
    auto const found = std::find(known.begin(), known.end(), word);
    if (found == known.end())
      fail_file(file, line,
                fmt::format("unknown column '{}'{}; the first line names columns out of {}", word,
                            did_you_mean(word, known), fmt::join(known, ", ")));
    int& place = at[found - known.begin()];
    if (place >= 0) fail_file(file, line, fmt::format("column '{}' is there twice", word));
    place = static_cast<int>(w);
  }
  for (Group const& g : groups)
    for (int k = g.first; k < g.first + g.count; ++k)
      if (at[k] < 0 && (g.first == 0 || at[g.first] >= 0))
        fail_file(file, line, fmt::format("column '{}' is missing", known[k]));
      else if (at[k] >= 0 && at[g.first] < 0)
        fail_file(file, line, fmt::format("column '{}' is missing beside '{}'", known[g.first], known[k]));
  return at;
}

}  // namespace

void read_insert_file(InsertCase& insert) {
  std::filesystem::path const& file = insert.file;
  std::string text = read_whole_file(file);
  for (char& c : text)
    if (c == ',' || c == '\r') c = ' ';
  Columns at{};
  std::size_t columns = 0;
  insert.position.clear(), insert.quaternion.clear();
  insert.velocities.clear(), insert.spins.clear(), insert.shape.clear();
  for_each_line(text, [&](int line, std::vector<std::string_view> const& words) {
    if (columns == 0) {
      at = read_columns(file, line, words);
      columns = words.size();
      return;
    }
    if (words.size() != columns) fail_file(file, line, fmt::format("{} values for {} columns", words.size(), columns));
    auto const value = [&](int k) { return read_number(file, line, words[at[k]]); };
    insert.position.push_back({value(0), value(1), value(2)});
    if (at[3] >= 0) {
      Quat const q{value(3), value(4), value(5), value(6)};
      double const length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
      if (!(std::abs(length - 1) <= 1e-3))
        fail_file(file, line, fmt::format("the quaternion has length {}, must be 1", length));
      insert.quaternion.push_back(q);
    }
    if (at[7] >= 0) insert.velocities.push_back({value(7), value(8), value(9)});
    if (at[10] >= 0) insert.spins.push_back({value(10), value(11), value(12)});
    if (at[13] >= 0) {
      double const shape = value(13);
      if (!(shape >= 0 && shape == std::floor(shape) && shape < 1e9))
        fail_file(file, line, fmt::format("shape {} is not a whole number from 0 on", shape));
      insert.shape.push_back(static_cast<int>(shape));
    }
  });
  if (columns == 0) fail_file(file, "is empty: the first line names the columns, e.g. x,y,z");
}

}  // namespace scree
