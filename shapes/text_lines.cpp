// text_lines.cpp: see text_lines.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/text_lines.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace scree {

void fail_file(std::filesystem::path const& file, std::string const& what) {
  throw std::runtime_error(file.string() + ": " + what);
}
void fail_file(std::filesystem::path const& file, int line, std::string const& what) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + what);
}

std::string lower_extension(std::filesystem::path const& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> found;
  std::size_t i = 0;
  while (i < line.size()) {
    while (i < line.size() && std::isspace(static_cast<unsigned char>(line[i]))) ++i;
    std::size_t const begin = i;
    while (i < line.size() && !std::isspace(static_cast<unsigned char>(line[i]))) ++i;
    if (i > begin && line[begin] == '#') break;
    if (i > begin) found.push_back(line.substr(begin, i - begin));
  }
  return found;
}

double read_number(std::filesystem::path const& file, int line, std::string_view word) {
  double value = 0;
  std::string_view const digits = word.front() == '+' ? word.substr(1) : word;
  auto const [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value))
    fail_file(file, line, "not a finite number: " + std::string(word));
  return value;
}

Vec3 read_vector(std::filesystem::path const& file, int line, std::vector<std::string_view> const& word, int first) {
  return {read_number(file, line, word[first]), read_number(file, line, word[first + 1]),
          read_number(file, line, word[first + 2])};
}

void append_vector(std::string& text, Vec3 v) {
  char buffer[32];
  for (int i = 0; i < 3; ++i) {
    auto const end = std::to_chars(buffer, buffer + sizeof(buffer), v[i]).ptr;
    text.append(1, ' ').append(buffer, end);
  }
}

}  // namespace scree
