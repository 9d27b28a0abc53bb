// made_shapes_cache_test.cpp: shapes made for a case come back bit for bit, and only for the same case.
// SPDX-License-Identifier: Apache-2.0
#include "core/made_shapes_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "shapes/content_cache.h"
#include "shapes/model_file.h"
#include "tests/support/pebble_decoder.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

class MadeShapesCache : public ::testing::Test {
 protected:
  MadeShapesCache() {
    folder = fs::temp_directory_path() / ("scree_made_" + std::to_string(::getpid()));
    ::setenv("SCREE_CACHE", folder.c_str(), 1);
    sampled.name = line.name = "grain";
    sampled.count = 1;
    line.count = 2;
    sampled.sample = SampleCase{"pebbles", "flat", 2, {}, {}, {}, {}, {}};
    line.interpolate = InterpolateCase{"pebbles", "flat/0", "long/0", 0.25, 0.75, true};
  }
  ~MadeShapesCache() override {
    ::setenv("SCREE_CACHE", "", 1);
    fs::remove_all(folder);
  }
  MadeShapes make(GrainsCase const& grains) {
    return cached_make_shapes(library, grains, limits, seed, group, 2, notes);
  }
  std::string key(GrainsCase const& grains) const { return made_shapes_key(library, grains, limits, seed, group); }
  fs::path file(GrainsCase const& grains) const { return folder / (key(grains) + ".h5"); }

  static void expect_same(MadeShapes const& a, MadeShapes const& b) {
    EXPECT_EQ(a.note, b.note);
    ASSERT_EQ(a.shape.size(), b.shape.size());
    for (std::size_t i = 0; i < a.shape.size(); ++i) {
      Shape const &s = a.shape[i], &t = b.shape[i];
      EXPECT_EQ(s.name, t.name);
      EXPECT_EQ(s.net, t.net);
      EXPECT_EQ(s.code, t.code);
      EXPECT_EQ(s.volume, t.volume);
      EXPECT_EQ(s.area, t.area);
      EXPECT_EQ(s.bounding_radius, t.bounding_radius);
      EXPECT_EQ(s.lipschitz, t.lipschitz);
      EXPECT_EQ(s.query.scale, t.query.scale);
      for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(s.inertia[k], t.inertia[k]);
        EXPECT_EQ(s.query.shift[k], t.query.shift[k]);
        EXPECT_EQ(s.box.min[k], t.box.min[k]);
        EXPECT_EQ(s.box.max[k], t.box.max[k]);
        for (int l = 0; l < 3; ++l) EXPECT_EQ(s.query.rotation.row[k][l], t.query.rotation.row[k][l]);
      }
      EXPECT_EQ(s.certificate.source, t.certificate.source);
      EXPECT_EQ(s.certificate.seed, t.certificate.seed);
      EXPECT_EQ(s.certificate.falling, t.certificate.falling);
      EXPECT_EQ(s.certificate.gradient_p5, t.certificate.gradient_p5);
    }
  }

  fs::path folder;
  Library library = test::pebble_library();
  GrainsCase sampled, line;
  LimitsCase limits;
  std::uint64_t seed = 5;
  int group = 1;
  std::vector<std::string> notes;
};

TEST_F(MadeShapesCache, WhatIsReadIsWhatWasMade) {
  for (GrainsCase const* grains : {&sampled, &line}) {
    MadeShapes const plain = make_shapes(library, *grains, limits, seed, group, 2), first = make(*grains);
    ASSERT_TRUE(fs::exists(file(*grains)));
    auto const written = fs::last_write_time(file(*grains));
    expect_same(first, plain);
    expect_same(make(*grains), plain);
    EXPECT_EQ(fs::last_write_time(file(*grains)), written);
  }
  EXPECT_TRUE(notes.empty());
}

TEST_F(MadeShapesCache, AHitIsRead) {
  make(sampled);
  make(line);
  fs::copy_file(file(line), file(sampled), fs::copy_options::overwrite_existing);
  expect_same(make(sampled), make(line));
}

TEST_F(MadeShapesCache, DamageIsDrawnAgainWithANote) {
  MadeShapes const first = make(sampled);
  std::ofstream(file(sampled)) << "no model file";
  expect_same(make(sampled), first);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("is damaged and is made again"), std::string::npos);
  expect_same(make(sampled), first);
  EXPECT_EQ(notes.size(), 1u);
}

TEST_F(MadeShapesCache, RefusalsAreNotKept) {
  sampled.sample->category = "flatt";
  EXPECT_THROW(make(sampled), std::invalid_argument);
  EXPECT_FALSE(fs::exists(file(sampled)));
}

struct Asked {
  Library library;
  GrainsCase grains;
  LimitsCase limits;
  std::uint64_t seed;
  int group;
  std::string key() const { return made_shapes_key(library, grains, limits, seed, group); }
};

TEST_F(MadeShapesCache, EverythingThatMattersChangesTheKey) {
  EXPECT_NE(key(sampled), key(line));
  auto const differs = [&](GrainsCase const& grains, auto const& change) {
    Asked asked{library, grains, limits, seed, group};
    change(asked);
    return asked.key() != key(grains);
  };
  EXPECT_TRUE(differs(sampled, [](Asked& a) { ++a.seed; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { ++a.group; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { a.limits.falling = 0.01; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { a.limits.gradient_low = 0.6; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { a.limits.gradient_high = 1.6; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { a.library.net[0].bias[1][0] += 1e-6f; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { a.library.shape[1].code[0] += 1e-6f; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { ++a.grains.count; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { a.grains.sample->category = "long"; }));
  EXPECT_TRUE(differs(sampled, [](Asked& a) { a.grains.sample->truncate = 1; }));
  for (FormScreen const& screen : form_screens()) {
    EXPECT_TRUE(differs(sampled, [&](Asked& a) { ((*a.grains.sample).*screen.wanted).low = 0.1; })) << screen.key;
    EXPECT_TRUE(differs(sampled, [&](Asked& a) { ((*a.grains.sample).*screen.wanted).high = 9; })) << screen.key;
  }
  EXPECT_TRUE(differs(line, [](Asked& a) { a.grains.interpolate->from = "flat/1"; }));
  EXPECT_TRUE(differs(line, [](Asked& a) { a.grains.interpolate->to = "long/1"; }));
  EXPECT_TRUE(differs(line, [](Asked& a) { a.grains.interpolate->low = 0.3; }));
  EXPECT_TRUE(differs(line, [](Asked& a) { a.grains.interpolate->high = 0.7; }));
  EXPECT_TRUE(differs(line, [](Asked& a) { a.grains.interpolate->random = false; }));
  EXPECT_FALSE(differs(sampled, [](Asked& a) { a.limits.mae = 0.5; }));
  EXPECT_FALSE(differs(sampled, [](Asked& a) { a.grains.diameter = 2; }));
}

}  // namespace
}  // namespace scree
