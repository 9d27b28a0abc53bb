// include_rules.h: which folder may include which; the table of the architecture as code.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace scree::architecture {

// The layer a path of the tree belongs to: "kernels/base", "kernels", "shapes", "shapes/mesh", "training", "core",
// "tools", "tests"; "" for anything else.
std::string layer_of(std::string const& path);

// Why `path` may not contain `#include <target>` or "target"; "" when it may.
std::string violation(std::string const& path, std::string const& target);

struct Include {
  int line = 0;
  std::string target;
};
std::vector<Include> includes_of(std::string const& source_text);

// Paths of our C++ sources relative to `root`, sorted.
std::vector<std::string> source_files(std::filesystem::path const& root);

std::string read_text(std::filesystem::path const& file);

}  // namespace scree::architecture
