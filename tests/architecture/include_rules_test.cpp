// include_rules_test.cpp: the tree keeps its layers, its file heads and its file names.
// SPDX-License-Identifier: Apache-2.0
#include "tests/architecture/include_rules.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

namespace {

using namespace scree::architecture;
namespace fs = std::filesystem;

fs::path const root = SCREE_SOURCE_DIR;

TEST(IncludeRules, PlantedViolationsAreSeen) {
  EXPECT_NE(violation("kernels/bounds.cpp", "shapes/shape.h"), "");
  EXPECT_NE(violation("kernels/base/vec.h", "kernels/bounds.h"), "");
  EXPECT_NE(violation("shapes/shape.h", "core/case.h"), "");
  EXPECT_NE(violation("shapes/zero_set.cpp", "shapes/mesh/mesh_check.h"), "");
  EXPECT_NE(violation("core/scene.cpp", "shapes/mesh/mesh_check.h"), "");
  EXPECT_NE(violation("core/scene.cpp", "shapes/exchange/onnx_file.h"), "");
  EXPECT_NE(violation("tools/scree_run.cpp", "shapes/exchange/onnx_file.h"), "");
  EXPECT_NE(violation("shapes/shape.cpp", "nlohmann/json.hpp"), "");
  EXPECT_NE(violation("shapes/mesh/certify.cpp", "onnx/onnx_pb.h"), "");
  EXPECT_NE(violation("core/scene.cpp", "training/fit.h"), "");
  EXPECT_NE(violation("training/fit.cpp", "core/case.h"), "");
  EXPECT_NE(violation("core/scene.cpp", "torch/torch.h"), "");
  EXPECT_NE(violation("shapes/shape.cpp", "CGAL/Surface_mesh.h"), "");
  EXPECT_NE(violation("kernels/bounds.cpp", "thrust/sort.h"), "");
  EXPECT_NE(violation("kernels/sdf/mlp.cpp", "Eigen/Dense"), "");
  EXPECT_NE(violation("kernels/sdf/mlp.cpp", "hdf5.h"), "");
  EXPECT_NE(violation("core/case.cpp", "toml++/toml.h"), "");
  EXPECT_NE(violation("tools/scree_run.cpp", "shapes/mesh/mesh_check.h"), "");
}

TEST(IncludeRules, WhatIsAllowedPasses) {
  EXPECT_EQ(violation("core/scene.cpp", "shapes/shape.h"), "");
  EXPECT_EQ(violation("shapes/mesh/mesh_check.cpp", "CGAL/Surface_mesh.h"), "");
  EXPECT_EQ(violation("shapes/exchange/onnx_file.cpp", "onnx/onnx_pb.h"), "");
  EXPECT_EQ(violation("training/fit.cpp", "torch/torch.h"), "");
  EXPECT_EQ(violation("tools/scree_train.cpp", "training/fit.h"), "");
  EXPECT_EQ(violation("kernels/base/sort_scan.cpp", "thrust/sort.h"), "");
  EXPECT_EQ(violation("kernels/bounds.cpp", "vector"), "");
}

TEST(IncludeRules, IncludeLinesAreFound) {
  std::vector<Include> const found = includes_of("#include <vector>\nint x;\n  #  include \"core/case.h\"  // why\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].target, "vector");
  EXPECT_EQ(found[1].target, "core/case.h");
  EXPECT_EQ(found[1].line, 3);
}

TEST(Tree, KeepsItsLayers) {
  std::vector<std::string> const files = source_files(root);
  ASSERT_GT(files.size(), 20u);
  for (std::string const& file : files)
    for (Include const& include : includes_of(read_text(root / file))) {
      std::string const why = violation(file, include.target);
      EXPECT_EQ(why, "") << file << ":" << include.line << ": #include " << include.target;
    }
}

// Line 1 names the file and its purpose; the licence stands in the head.
TEST(Tree, EveryFileHasItsHead) {
  for (std::string const& file : source_files(root)) {
    std::istringstream stream(read_text(root / file));
    std::string first, line;
    std::getline(stream, first);
    EXPECT_TRUE(first.starts_with("// " + fs::path(file).filename().string() + ": "))
        << file << " starts with: " << first;
    bool licensed = false;
    for (std::string text = first; stream && text.starts_with("//"); std::getline(stream, text))
      licensed = licensed || text == "// SPDX-License-Identifier: Apache-2.0";
    EXPECT_TRUE(licensed) << file << " has no SPDX line in its head";
  }
}

TEST(Tree, HeadersAreGuarded) {
  for (std::string const& file : source_files(root))
    if (file.ends_with(".h")) {
      EXPECT_NE(read_text(root / file).find("\n#pragma once\n"), std::string::npos) << file;
    }
}

TEST(Tree, NoFileIsNamedForNothing) {
  std::set<std::string> const forbidden{"utils", "util", "helpers", "helper", "common", "misc"};
  for (std::string const& file : source_files(root))
    EXPECT_FALSE(forbidden.contains(fs::path(file).stem().string())) << file;
}

}  // namespace
