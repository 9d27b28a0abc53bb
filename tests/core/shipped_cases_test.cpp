// shipped_cases_test.cpp: every case under cases/ is read without a complaint, so that keys cannot move away from them.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/case.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// Files that the user brings, here others in their place.
std::map<std::string, std::vector<std::string>> const brought = {
    {"slope/terrain.toml",
     {"wall.slope.file=slope.asc", "grains.reference.insert.file=release.csv",
      "grains.interpolation.insert.file=release.csv", "grains.sampling.insert.file=release.csv"}},
};

TEST(ShippedCases, AreRead) {
  fs::path const folder = SCREE_SOURCE_DIR "/cases";
  int cases = 0;
  for (fs::directory_entry const& entry : fs::recursive_directory_iterator(folder)) {
    fs::path const& file = entry.path();
    if (file.extension() != ".toml" || file.filename().string().starts_with("expected")) continue;
    ++cases;
    auto const keys = brought.find(fs::relative(file, folder).string());
    try {
      Case const c = load_case(file, keys == brought.end() ? std::vector<std::string>() : keys->second);
      EXPECT_FALSE(c.grains.empty()) << file;
    } catch (InputError const& error) {
      for (std::string const& problem : error.problems) ADD_FAILURE() << problem;
    }
  }
  EXPECT_GE(cases, 7);  // as many as there were when this was written: the folder was found
}

// Rocks of the three groups start at the same points, and one key makes it 100 a group.
TEST(ShippedCases, SlopeGroupsShareTheirReleasePoints) {
  Case const c = load_case(SCREE_SOURCE_DIR "/cases/slope/rockfall.toml", {"case.replicas=5"});
  ASSERT_EQ(c.grains.size(), 3u);
  for (GrainsCase const& g : c.grains) {
    EXPECT_EQ(g.insert.position, c.grains[0].insert.position);
    EXPECT_EQ(g.insert.velocity, (Vec3{0, 0, -1}));
    EXPECT_EQ(g.count * c.replicas, 100);
    EXPECT_TRUE(g.apart);
  }
}

}  // namespace
}  // namespace scree
