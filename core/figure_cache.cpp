// figure_cache.cpp: see figure_cache.h. Kept is text: a line of its kind, a number a line, a hash of them.
// SPDX-License-Identifier: Apache-2.0
#include "core/figure_cache.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <sstream>

#include "shapes/content_cache.h"
#include "shapes/whole_file.h"

namespace scree {
namespace {

char constexpr kind[] = "scree figures 1";

std::string text_of(std::string const& key, std::vector<double> const& figures) {
  std::string text = fmt::format("{}\n{}\n{}\n", kind, key, figures.size());
  for (double const v : figures) text += fmt::format("{}\n", v);
  return text + ContentHash().add(text).digits() + "\n";
}

std::optional<std::filesystem::path> file_of(std::string const& key) {
  std::filesystem::path const folder = cache_folder();
  if (folder.empty()) return std::nullopt;
  return folder / (key + ".figures");
}

}  // namespace

std::vector<double> read_figures(std::string const& key) {
  std::optional<std::filesystem::path> const file = file_of(key);
  std::error_code error;
  if (!file || !std::filesystem::exists(*file, error)) return {};
  try {
    std::string const text = read_whole_file(*file);
    std::istringstream in(text);
    std::string line;
    std::size_t count = 0;
    std::getline(in, line), std::getline(in, line);
    in >> count;
    std::vector<double> figures;
    for (double v = 0; figures.size() < count && in >> v;) figures.push_back(v);
    return text_of(key, figures) == text ? figures : std::vector<double>{};
  } catch (std::exception const&) {
    return {};
  }
}

void keep_figures(std::string const& key, std::vector<double> const& figures) {
  std::optional<std::filesystem::path> const file = file_of(key);
  if (!file) return;
  try {
    std::filesystem::create_directories(file->parent_path());
    replace_whole_file(*file, text_of(key, figures));
  } catch (std::exception const&) {
    return;
  }
}

}  // namespace scree
