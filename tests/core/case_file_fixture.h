// case_file_fixture.h: a small case file to change, load and see refused.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/case.h"
#include "tests/support/changed_text.h"

namespace scree::testing {

namespace fs = std::filesystem;

inline char const* const minimal = R"([case]
name = "drop"
[time]
end = 1.5
[gravity]
acceleration = [0, 0, -9.81]
[[material]]
name = "rock"
density = 2650
[[contact]]
pair = ["rock", "rock"]
normal = { stiffness = 2e6, at_overlap = 0.01 }
friction = 0.5
damping = { ratio = 0.7 }
[[grains]]
name = "mix"
material = "rock"
shapes = ["sphere"]
count = 5
diameter = 0.1
insert = { kind = "lattice", box = [[0, 0, 0], [1, 1, 4]] }
[[wall]]
name = "floor"
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "rock"
)";

class CaseFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("scree_case_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(std::string const& text, std::string const& name = "case.toml") {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Case load(std::string const& text, std::vector<std::string> const& overrides = {}) {
    return load_case(write(text), overrides);
  }
  // The problems of `text`, without the folder's name.
  std::vector<std::string> refused(std::string const& text, std::vector<std::string> const& overrides = {}) {
    try {
      load(text, overrides);
    } catch (InputError const& error) {
      std::vector<std::string> lines = error.problems;
      std::string const prefix = folder_.string() + "/";
      for (std::string& line : lines)
        if (line.starts_with(prefix)) line = line.substr(prefix.size());
      return lines;
    }
    return {};
  }
  // Expects exactly one problem that contains every one of `parts`.
  void expect_one(std::vector<std::string> const& problems, std::vector<std::string> const& parts) {
    ASSERT_EQ(problems.size(), 1u) << ::testing::PrintToString(problems);
    for (std::string const& part : parts)
      EXPECT_NE(problems[0].find(part), std::string::npos) << problems[0] << "\nlacks: " << part;
  }

  fs::path folder_;
};

}  // namespace scree::testing
