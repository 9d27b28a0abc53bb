// case_keys_test.cpp: the documented keys are the keys that are read, their ranges are those that are judged, and
// CASE_FILE.md holds the reference that the program prints.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_keys.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "core/case.h"
#include "core/case_reference.h"
#include "core/case_text.h"
#include "core/measure_kinds.h"

namespace scree {
namespace {

TEST(CaseKeys, DocumentedKeysAreTheOnesThatAreRead) {
  std::set<std::string> documented, asked;
  for (CaseKey const& k : case_keys()) {
    EXPECT_TRUE(documented.insert(k.path).second) << k.path << " has two rows";
    EXPECT_STRNE(k.meaning, "") << k.path;
    EXPECT_EQ(std::string(k.meaning).find_first_of("\n"), std::string::npos) << k.path;
  }
  for (AskedKey const& a : all_keys_asked()) asked.insert(a.path);
  EXPECT_EQ(asked, documented);
  for (MeasureKind const& k : measure_kinds()) EXPECT_STRNE(k.meaning, "") << k.name;
}

// A key without a row is unknown even where the parser asks for it.
TEST(CaseKeys, AKeyWithoutARowCannotBeRead) {
  CaseNode const root = parse_case_text("[time]\nend = 2\nsecret = 3\n", "case.toml");
  CaseProblems problems;
  problems.documented = [](std::string const& path) { return find_case_key(path) != nullptr; };
  CaseReader reader(root, "", problems);
  auto time = reader.table("time");
  ASSERT_TRUE(time);
  double end = 0, secret = 0;
  EXPECT_TRUE(time->number("end", end));
  EXPECT_FALSE(time->number("secret", secret));
  EXPECT_EQ(secret, 0);
  time->finish();
  ASSERT_EQ(problems.found.size(), 1u);
  EXPECT_EQ(problems.found[0].key, "time.secret");
  EXPECT_NE(problems.found[0].text.find("unknown key"), std::string::npos);
}

TEST(CaseKeys, IndicesAreNoPartOfAPath) {
  EXPECT_EQ(without_indices("grains.12.insert.kind"), "grains.insert.kind");
  EXPECT_EQ(without_indices(""), "");
  ASSERT_NE(find_case_key("wall.0.kind"), nullptr);
  EXPECT_STREQ(find_case_key("wall.0.kind")->path, "wall.kind");
  EXPECT_EQ(find_case_key("wall.0.kinds"), nullptr);
}

// A good case in which each key that has a range can be set somewhere.
char const* const every_key = R"([case]
replicas = 1
[time]
end = 1e9
settle = {}
[drag]
density = 1
coefficient = 0.5
[damping]
rate = 1
[[library]]
name = "grains"
file = "grains.h5"
[[material]]
name = "a"
density = 2650
[[material]]
name = "b"
density = 2650
[[material]]
name = "c"
density = 2650
[[contact]]
pair = ["a", "a"]
normal = { stiffness = 2e6 }
damping = { ratio = 0.7 }
rolling = { friction = 0.1 }
cohesion = { traction = 1, range = 0.001 }
[[contact]]
pair = ["a", "b"]
law = "linear"
normal = { stiffness = 2e6 }
damping = { restitution = 0.5 }
[[contact]]
pair = ["b", "b"]
law = "hertz"
normal = { youngs_modulus = 1e7, poisson_ratio = 0.3 }
[[contact]]
pair = ["c", "c"]
normal = { kappa = 1e9 }
[[grains]]
name = "placed"
material = "a"
shapes = ["sphere"]
evaluator = "grid"
count = 0
diameter = 0.1
insert = { kind = "random", box = [[0, 0, 0], [1, 1, 1]] }
[[grains]]
name = "poured"
material = "b"
shapes = ["sphere"]
evaluator = "mesh"
count = 0
diameter = 0.1
insert = { kind = "rate", box = [[0, 0, 0], [1, 1, 1]], rate = 1 }
[[grains]]
name = "sampled"
material = "b"
sample = { library = "grains", category = "ballast" }
count = 0
diameter = 0.1
insert = { kind = "random", box = [[0, 0, 0], [1, 1, 1]] }
[[grains]]
name = "between"
material = "b"
interpolate = { library = "grains", from = "x", to = "y", t = 0.5 }
count = 0
diameter = 0.1
insert = { kind = "random", box = [[0, 0, 0], [1, 1, 1]] }
[[wall]]
name = "tube"
kind = "cylinder"
material = "a"
from = [0, 0, 0]
to = [0, 0, 1]
radius = 1
motion = { kind = "rotation", axis = [0, 0, 1], through = [0, 0, 0], rate = 1 }
[[wall]]
name = "shell"
kind = "cone"
material = "a"
from = [0, 0, 0]
to = [0, 0, 1]
radius_from = 1
radius_to = 1
thickness = 0.1
[[wall]]
name = "ground"
kind = "mesh"
material = "a"
file = "grains.h5"
[[measure]]
name = "bed"
kind = "packing_fraction"
cylinder = { from = [0, 0, 0], to = [0, 0, 1], radius = 1 }
[[measure]]
name = "stop"
kind = "blockage"
point = [0, 0, 0]
normal = [0, 0, 1]
longer_than = 1
[[measure]]
name = "heap"
kind = "pile_angle"
[[measure]]
name = "chains"
kind = "force_chains"
[checkpoint]
[relax]
)";

// "(0, 0.5]" -> its ends, and whether they belong to it.
struct Range {
  double end[2];
  bool closed[2];
};

Range range_of(std::string const& text) {
  std::size_t const comma = text.find(", ");
  auto const value = [](std::string const& word) { return word == "inf" ? INFINITY : std::stod(word); };
  return {{value(text.substr(1, comma - 1)), value(text.substr(comma + 2, text.size() - comma - 3))},
          {text.front() == '[', text.back() == ']'}};
}

class Ranges : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / fmt::format("scree_case_keys_test_{}", ::getpid());
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "grains.h5") << "only looked for";
    std::ofstream(folder_ / "case.toml") << every_key;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // Whether the key may have `value`; `place`: in which entry of its list. Problems of other keys do not matter.
  bool takes(std::string const& path, int place, double value, bool whole) {
    std::string at = path;
    for (char const* list : {"material", "contact", "grains", "wall", "measure"})
      if (path.starts_with(list)) at = fmt::format("{}.{}{}", list, place, path.substr(std::string(list).size()));
    std::string const text = whole ? fmt::format("{:.0f}", value) : fmt::format("{}", value);
    try {
      load_case(folder_ / "case.toml", {at + "=" + text});
    } catch (InputError const& error) {
      std::string const end_of_key = path.substr(path.rfind('.')) + ": ";
      return std::none_of(error.problems.begin(), error.problems.end(),
                          [&](std::string const& p) { return p.find(end_of_key) != std::string::npos; });
    }
    return true;
  }

  std::filesystem::path folder_;
};

TEST_F(Ranges, AreThoseThatTheCaseIsJudgedBy) {
  ASSERT_NO_THROW(load_case(folder_ / "case.toml", {}));
  std::set<std::string> whole;
  for (AskedKey const& a : all_keys_asked())
    if (a.type == "whole number") whole.insert(a.path);
  int tried = 0;
  for (CaseKey const& key : case_keys()) {
    if (!*key.range) continue;
    SCOPED_TRACE(fmt::format("{} {}", key.path, key.range));
    bool const counts = whole.count(key.path) > 0;
    Range const range = range_of(key.range);
    double const low = range.end[0], high = range.end[1];
    double const step = counts ? 1 : 1e-6;
    double const within = low + std::max(step, std::isfinite(high) ? (high - low) / 2 : 1);
    int place = 0;  // the first entry that takes the key
    while (place < 4 && !takes(key.path, place, counts ? std::floor(within) : within, counts)) ++place;
    ASSERT_LT(place, 4) << "no entry takes " << within;
    auto const good = [&](double value) { return takes(key.path, place, value, counts); };
    EXPECT_EQ(good(low), range.closed[0]);
    EXPECT_FALSE(good(low - step));
    if (std::isfinite(high)) {
      EXPECT_EQ(good(high), range.closed[1]);
      EXPECT_FALSE(good(high + (counts ? 1 : 1e-6 * high)));
    } else {
      EXPECT_TRUE(good(1e6));
    }
    ++tried;
  }
  EXPECT_GT(tried, 50);
}

TEST(CaseReference, TypesDefaultsAndKindsAreThoseOfTheParser) {
  std::string const limits = case_reference("limits");
  LimitsCase const usual;
  EXPECT_NE(limits.find(fmt::format("| `overlap` | number | `{}` | `(0, 0.5]` |", usual.overlap)), std::string::npos)
      << limits;
  EXPECT_NE(
      limits.find(fmt::format("| `gradient` | `[low, high]` | `[{}, {}]` |", usual.gradient_low, usual.gradient_high)),
      std::string::npos)
      << limits;
  EXPECT_EQ(limits.find("[time]"), std::string::npos);
  std::string const wall = case_reference("wall");
  EXPECT_NE(wall.find("| `radius` | number | required | `(0, inf)` | *cylinder, capsule:*"), std::string::npos) << wall;
  EXPECT_NE(wall.find("| `name` | string | required |"), std::string::npos) << wall;
  EXPECT_EQ(case_reference("no such key"), "");
}

TEST(CaseReference, StandsInCaseFileMd) {
  std::ifstream in(SCREE_SOURCE_DIR "/core/CASE_FILE.md");
  std::stringstream text;
  text << in.rdbuf();
  std::string const page = text.str(), begin = "<!-- begin: scree keys -->\n", end = "<!-- end: scree keys -->\n";
  std::size_t const first = page.find(begin), last = page.find(end);
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  EXPECT_EQ(page.substr(first + begin.size(), last - first - begin.size()), case_reference())
      << "put the output of `scree keys` between the two marks of core/CASE_FILE.md";
}

}  // namespace
}  // namespace scree
