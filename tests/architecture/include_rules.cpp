// include_rules.cpp: see include_rules.h.
// SPDX-License-Identifier: Apache-2.0
#include "tests/architecture/include_rules.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace scree::architecture {
namespace {

using Set = std::set<std::string>;

// Every layer may include itself and these.
std::map<std::string, Set> const& allowed_layers() {
  static std::map<std::string, Set> const table{
      {"kernels/base", {}},
      {"kernels", {"kernels/base"}},
      {"shapes", {"kernels/base", "kernels"}},
      {"shapes/exchange", {"kernels/base", "kernels", "shapes"}},
      {"shapes/mesh", {"kernels/base", "kernels", "shapes"}},
      {"training", {"kernels/base", "kernels", "shapes", "shapes/mesh"}},
      {"core", {"kernels/base", "kernels", "shapes"}},
      {"tools", {"kernels/base", "kernels", "shapes", "shapes/exchange", "shapes/mesh", "training", "core"}},
      {"tests", {"kernels/base", "kernels", "shapes", "shapes/exchange", "shapes/mesh", "training", "core", "tools"}}};
  return table;
}

// Programs that are built without CGAL and LibTorch, and so may not see the layers that need them.
bool is_engine_program(std::string const& path) {
  return path.starts_with("tools/scree") && !path.starts_with("tools/scree_shape") &&
         !path.starts_with("tools/scree_train");
}

struct ForeignRule {
  char const* pattern;  // of the included name
  char const* library;
  Set layers;  // where it may appear
  Set files;   // and in these files
};

std::vector<ForeignRule> const& foreign_rules() {
  static std::vector<ForeignRule> const rules{
      {"^(torch|ATen|c10)/",
       "LibTorch",
       {"training", "tests"},
       {"tools/scree_train.cpp", "tools/bench/opponent_torch.cpp"}},
      {"^CGAL/",
       "CGAL",
       {"shapes/mesh", "tests"},
       {"tools/scree_shape.cpp", "tools/scree_train.cpp", "tools/bench/opponent_cgal.cpp"}},
      {"^thrust/|^cub/", "Thrust", {}, {"kernels/base/sort_scan.cpp"}},
      {"^toml\\+\\+/", "toml++", {}, {"core/case_tree.cpp"}},
      {"^H5|^hdf5", "HDF5", {"shapes", "core", "tests"}, {}},
      {"^Eigen/", "Eigen", {"shapes", "shapes/mesh", "training", "tests"}, {"tools/bench/opponent_eigen.cpp"}},
      {"^nlohmann/", "nlohmann-json", {"shapes/exchange", "tests"}, {}},
      {"^onnx/|^google/protobuf", "ONNX", {"shapes/exchange"}, {}},
      {"^CLI/", "CLI11", {"tools"}, {}},
      {"^png", "libpng", {"core", "tools", "tests"}, {}}};
  return rules;
}

}  // namespace

std::string layer_of(std::string const& path) {
  for (char const* layer :
       {"kernels/base", "kernels", "shapes/exchange", "shapes/mesh", "shapes", "training", "core", "tools", "tests"})
    if (path.starts_with(std::string(layer) + "/")) return layer;
  return "";
}

std::string violation(std::string const& path, std::string const& target) {
  std::string const from = layer_of(path), to = layer_of(target);
  if (!to.empty()) {
    if (from != to && !allowed_layers().at(from).contains(to)) return from + " may not include " + to;
    if (is_engine_program(path) && (to == "training" || to == "shapes/mesh" || to == "shapes/exchange"))
      return "an engine program may not include " + to;
    return "";
  }
  for (ForeignRule const& rule : foreign_rules())
    if (std::regex_search(target, std::regex(rule.pattern)) && !rule.layers.contains(from) &&
        !rule.files.contains(path))
      return std::string(rule.library) + " may not be included here";
  return "";
}

std::vector<Include> includes_of(std::string const& source_text) {
  static std::regex const pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> out;
  std::istringstream stream(source_text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::smatch match;
    if (std::regex_search(line, match, pattern)) out.push_back({number, match[1]});
  }
  return out;
}

std::vector<std::string> source_files(std::filesystem::path const& root) {
  Set const extensions{".h", ".cpp", ".cu", ".cuh"};
  std::vector<std::string> out;
  for (char const* folder : {"kernels", "shapes", "training", "core", "tools", "tests"})
    for (auto const& entry : std::filesystem::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
        out.push_back(std::filesystem::relative(entry.path(), root).generic_string());
  std::sort(out.begin(), out.end());
  return out;
}

std::string read_text(std::filesystem::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace scree::architecture
