// program_fixture.h: the scree program in a scratch folder, with a small case to run or to spoil.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "shapes/analytic_shapes.h"
#include "shapes/model_file.h"
#include "tests/support/changed_text.h"
#include "tests/support/shell.h"

namespace scree::testing {

namespace fs = std::filesystem;

// One sphere 1 mm above a floor, 2 ms: a run of a fraction of a second.
inline char const* const small_case = R"([case]
name = "small"
[time]
end = 0.002
step = 1e-5
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e6 }
[[grains]]
name = "one"
material = "rock"
shapes = ["sphere"]
evaluator = "analytic"
diameter = 0.1
insert = { kind = "list", position = [[0, 0, 0.051]], velocity = [0, 0, -1] }
[[wall]]
name = "floor"
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "rock"
[output]
every = 0.001
)";

inline std::string read_file(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class Program : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_cli_test_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Outcome scree(std::string const& arguments) const { return shell(folder_, SCREE_PROGRAM " " + arguments); }

  fs::path write(std::string const& name, std::string const& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  // `scree run` of this text must fail with exactly this code, say all of `parts`, and leave no trace, also not in
  // the output folder of an earlier run that --force would replace.
  void expect_refused(std::string const& text, int code, std::vector<std::string> const& parts) const {
    write("bad.toml", text);
    fs::create_directories(folder_ / "old");
    write("old/results.h5", "results of an earlier run");
    Outcome const outcome = scree("run bad.toml --force --output old");
    EXPECT_EQ(outcome.code, code) << outcome.text;
    for (std::string const& part : parts)
      EXPECT_NE(outcome.text.find(part), std::string::npos) << outcome.text << "lacks: " << part;
    EXPECT_EQ(read_file(folder_ / "old/results.h5"), "results of an earlier run");
    EXPECT_EQ(scree("run bad.toml --output new").code, code);
    EXPECT_FALSE(fs::exists(folder_ / "new"));
  }

  // A model file with one small network, "ballast/0": phi = 0.5 - |x|_1-like, enough to be read.
  fs::path write_small_model(char const* name) const {
    Library library;
    Mlp net;
    net.width = {3, 8, 1};
    net.weight = {std::vector<float>(24, 0.1f), std::vector<float>(8, -0.1f)};
    net.bias = {std::vector<float>(8, 0.0f), {0.3f}};
    library.net.push_back(net);
    Shape shape = make_sphere();
    shape.name = "ballast/0";
    shape.kind = ShapeKind::net;
    shape.net = 0;
    library.shape.push_back(shape);
    write_model(folder_ / name, library);
    return folder_ / name;
  }

  std::string case_with_library(std::string const& shape) const {
    return with(with(small_case, "[\"sphere\"]\nevaluator = \"analytic\"", "[\"" + shape + "\"]"), "[[material]]",
                "[[library]]\nname = \"grains\"\nfile = \"model.h5\"\n[[material]]");
  }

  fs::path folder_;
};

}  // namespace scree::testing
