// text_lines.h: geometry files as text: lines cut into words, numbers, complaints with file and line.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/base/vec.h"

namespace scree {

// Throw std::runtime_error "<file>: what" or "<file>:<line>: what".
[[noreturn]] void fail_file(std::filesystem::path const& file, std::string const& what);
[[noreturn]] void fail_file(std::filesystem::path const& file, int line, std::string const& what);

// ".STL" of "a.STL" as ".stl".
std::string lower_extension(std::filesystem::path const& file);

// Words of one line, up to a word that begins with '#'.
std::vector<std::string_view> words(std::string_view line);

// Calls visit(line number from 1, words) for each line that has words.
template <class Visit>
void for_each_line(std::string_view text, Visit const& visit) {
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t const end = std::min(text.find('\n', begin), text.size());
    ++number;
    auto const found = words(text.substr(begin, end - begin));
    if (!found.empty()) visit(number, found);
    begin = end + 1;
  }
}

// A finite number that fills the whole word, else a complaint.
double read_number(std::filesystem::path const& file, int line, std::string_view word);
// Three of them from word `first` on; the caller has checked that they are there.
Vec3 read_vector(std::filesystem::path const& file, int line, std::vector<std::string_view> const& word, int first);

// " x y z", each in the shortest form that reads back to the same bits.
void append_vector(std::string& text, Vec3 v);

}  // namespace scree
