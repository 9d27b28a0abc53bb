// test_bake_cache.cpp: what is kept, found, replaced, and what changes the key.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "shapes/bake_cache.h"
#include "shapes/content_cache.h"
#include "tests/support/shape_kinds.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

class BakeCache : public ::testing::Test {
 protected:
  BakeCache() {
    folder = fs::temp_directory_path() / ("scree_cache_" + std::to_string(::getpid()));
    ::setenv("SCREE_CACHE", folder.c_str(), 1);
  }
  ~BakeCache() override {
    ::unsetenv("SCREE_CACHE");
    fs::remove_all(folder);
  }
  Library bake() { return cached_bake(library, library.shape[0], request, notes); }
  fs::path file() const { return folder / (bake_key(library, library.shape[0], request) + ".h5"); }

  fs::path folder;
  Library library = library_of_kind("single_net");
  BakeRequest request{ShapeKind::grid, 10, 1};
  std::vector<std::string> notes;
};

TEST_F(BakeCache, MadeOnceThenReadBitForBit) {
  Library const first = bake();
  ASSERT_TRUE(fs::exists(file()));
  auto const written = fs::last_write_time(file());
  Library const second = bake();
  EXPECT_EQ(fs::last_write_time(file()), written);
  EXPECT_EQ(first.grid.at(0)->value, second.grid.at(0)->value);
  EXPECT_EQ(first.shape[0].lipschitz, second.shape[0].lipschitz);
  EXPECT_EQ(second.shape[0].name, "single_net");
  EXPECT_EQ(second.shape[0].kind, ShapeKind::grid);
  EXPECT_TRUE(notes.empty());
  int files = 0;
  for ([[maybe_unused]] auto const& entry : fs::directory_iterator(folder)) ++files;
  EXPECT_EQ(files, 1);  // no temporary is left
}

// A hit is really read: what the file says is what comes back.
TEST_F(BakeCache, AHitIsRead) {
  bake();
  fs::path const net_file = file();
  Library const other = library_of_kind("ellipsoid");
  Library const foreign = cached_bake(other, other.shape[0], request, notes);
  fs::copy_file(folder / (bake_key(other, other.shape[0], request) + ".h5"), net_file,
                fs::copy_options::overwrite_existing);
  EXPECT_EQ(bake().grid.at(0)->value, foreign.grid.at(0)->value);
}

TEST_F(BakeCache, DamageIsRepairedWithANote) {
  Library const first = bake();
  {
    std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(3000);
    stream.put('\x55').put('\x2a');
  }
  EXPECT_EQ(bake().grid.at(0)->value, first.grid.at(0)->value);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("is damaged and is made again"), std::string::npos);
  bake();
  EXPECT_EQ(notes.size(), 1u);
}

TEST_F(BakeCache, AFolderThatCannotBeIsANoteNotAnError) {
  std::ofstream(folder) << "a file where the folder should be";
  EXPECT_EQ(bake().shape.at(0).kind, ShapeKind::grid);
  bake();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("SCREE_CACHE"), std::string::npos);
}

TEST_F(BakeCache, AnEmptyVariableKeepsNothing) {
  ::setenv("SCREE_CACHE", "", 1);
  bake();
  EXPECT_TRUE(notes.empty());
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(BakeCache, EverythingThatMattersChangesTheKey) {
  std::string const key = bake_key(library, library.shape[0], request);
  auto const differs = [&](auto const& change) {
    Library changed = library;
    BakeRequest asked = request;
    change(changed, asked);
    return bake_key(changed, changed.shape[0], asked) != key;
  };
  EXPECT_TRUE(differs([](Library& l, BakeRequest&) { l.net[0].weight[1][3] += 1e-6f; }));
  EXPECT_TRUE(differs([](Library& l, BakeRequest&) { l.net[0].parameter = 11; }));
  EXPECT_TRUE(differs([](Library& l, BakeRequest&) { l.shape[0].code = {0.1f}; }));
  EXPECT_TRUE(differs([](Library& l, BakeRequest&) { l.shape[0].query.shift.y = 1e-9; }));
  EXPECT_TRUE(differs([](Library& l, BakeRequest&) { l.shape[0].box.max.z += 1e-9; }));
  EXPECT_TRUE(differs([](Library&, BakeRequest& r) { r.cells = 11; }));
  EXPECT_TRUE(differs([](Library&, BakeRequest& r) { r.kind = ShapeKind::mesh; }));
  EXPECT_FALSE(differs([](Library& l, BakeRequest&) { l.shape[0].name = "other"; }));
  EXPECT_FALSE(differs([](Library&, BakeRequest& r) { r.threads = 2; }));
  for (char const* kind : {"harmonics", "mesh", "grid", "box"}) {
    Library const one = library_of_kind(kind);
    EXPECT_NE(bake_key(one, one.shape[0], request), key) << kind;
  }
}

TEST(BakeCacheFolder, FollowsTheEnvironment) {
  auto const restore = [](char const* name, char const* value) { value ? ::setenv(name, value, 1) : ::unsetenv(name); };
  std::string const home = std::getenv("HOME") ? std::getenv("HOME") : "";
  ::unsetenv("SCREE_CACHE");
  ::setenv("XDG_CACHE_HOME", "/x", 1);
  EXPECT_EQ(cache_folder(), "/x/scree");
  ::setenv("XDG_CACHE_HOME", "relative", 1);  // the XDG rule: ignored
  ::setenv("HOME", "/h", 1);
  EXPECT_EQ(cache_folder(), "/h/.cache/scree");
  ::setenv("SCREE_CACHE", "/own", 1);
  EXPECT_EQ(cache_folder(), "/own");
  ::setenv("SCREE_CACHE", "", 1);
  EXPECT_EQ(cache_folder(), "");
  ::unsetenv("SCREE_CACHE");
  ::unsetenv("XDG_CACHE_HOME");
  ::unsetenv("HOME");
  EXPECT_EQ(cache_folder(), "");
  restore("HOME", home.empty() ? nullptr : home.c_str());
}

}  // namespace
}  // namespace scree
