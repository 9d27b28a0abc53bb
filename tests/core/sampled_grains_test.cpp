// sampled_grains_test.cpp: shapes made for a case: only the seed decides, both storages alike, what is refused.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/grain_entries.h"
#include "core/sampled_grains.h"
#include "core/simulation_impl.h"
#include "shapes/model_file.h"
#include "tests/support/cases.h"
#include "tests/support/pebble_decoder.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;
using Code = std::vector<float>;

// Pebbles, and two codes between which there is no solid.
class MadeGrains : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    file_ = fs::temp_directory_path() / ("scree_sampled_" + std::to_string(::getpid()) + ".h5");
    library_ = test::pebble_library();
    for (float z : {8.0f, 8.2f}) {
      Shape gone = library_.shape[0];
      gone.name = "gone/" + std::to_string(library_.shape.size());
      gone.code = {z, 8};
      library_.shape.push_back(gone);
    }
    write_model(file_, library_, true);
  }
  static void TearDownTestSuite() { fs::remove(file_); }

  static Case case_of(int count) {
    Case c = rock_case();
    c.library = {{"pebbles", file_}};
    std::vector<Vec3> position;
    for (int i = 0; i < count; ++i) position.push_back({0.3 * i, 0, 0.2});
    GrainsCase g = grains_at("sphere", position, 0.1, 250);
    g.shapes = {};
    c.grains = {g};
    c.wall = {floor_at(0)};
    return c;
  }
  static Case sampled(int count, NodeStorage storage = NodeStorage::explicit_) {
    Case c = case_of(count);
    c.grains[0].sample = SampleCase{"pebbles", "flat", 2, {}, {}, {}, {}, {}};
    c.grains[0].storage = storage;
    return c;
  }
  static Case on_line(int count, double low, double high, bool random = false) {
    Case c = case_of(count);
    c.grains[0].interpolate = InterpolateCase{"pebbles", "flat/0", "long/0", low, high, random};
    return c;
  }

  // Of every body, in the order of the bodies.
  static std::vector<Code> codes(Simulation& s) {
    Scene const& scene = s.impl().scene;
    std::vector<Code> out;
    for (int shape : scene.shape_of) out.push_back(scene.template_shape(shape).code);
    return out;
  }
  // Of the shapes made for the first entry, without a scene.
  static std::vector<Code> made(Case const& c, int threads = 2) {
    std::vector<Code> out;
    for (Shape const& s : make_shapes(library_, c.grains[0], c.limits, c.seed, 0, threads).shape) out.push_back(s.code);
    return out;
  }
  static void expect_refused(Case const& c, std::string const& part) {
    try {
      Simulation s(c, {.threads = 2});
      FAIL() << "nothing was refused";
    } catch (InputError const& e) {
      EXPECT_EQ(e.problems.size(), 1u) << e.what();
      EXPECT_TRUE(says(e.what(), part)) << e.what();
    }
  }
  static bool says(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

  static inline fs::path file_;
  static inline Library library_;
};

TEST_F(MadeGrains, EveryGrainIsItsOwnAndOnlyTheSeedDecides) {
  Case c = sampled(2);
  std::vector<Code> const one = made(c, 1);
  std::set<Code> different(one.begin(), one.end());
  for (Shape const& s : library_.shape) different.insert(s.code);
  EXPECT_EQ(different.size(), 2 + library_.shape.size());
  EXPECT_EQ(made(c, 2), one);
  c.seed = 2;
  for (Code const& code : made(c)) EXPECT_TRUE(different.insert(code).second) << "another seed gave the same grain";

  // A second entry draws for itself, and does not change the first.
  c = sampled(2);
  c.grains.push_back(c.grains[0]);
  c.grains[1].name = "other";
  for (Vec3& x : c.grains[1].insert.position) x.y = 1;
  Simulation s(c, {.threads = 2});
  std::vector<Code> const both = codes(s);
  std::set<Code> const first(both.begin(), both.begin() + 2), all(both.begin(), both.end());
  EXPECT_EQ(first, std::set<Code>(one.begin(), one.end()));
  EXPECT_EQ(all.size(), 4u);
}

TEST_F(MadeGrains, BothStoragesHoldTheSameGrains) {
  Simulation arrays(sampled(2), {.threads = 2}), compact(sampled(2, NodeStorage::compact), {.threads = 2});
  Scene const &a = arrays.impl().scene, &b = compact.impl().scene;
  EXPECT_EQ(codes(arrays), codes(compact));
  EXPECT_FALSE(a.node_position.empty());
  EXPECT_TRUE(b.node_position.empty());
  EXPECT_EQ(b.compact.record.size(), 2u);
  EXPECT_EQ(a.networks.net.size(), 1u);
  EXPECT_EQ(b.networks.net.size(), 1u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(a.mass[i], b.mass[i]);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.inertia[i][k] / b.inertia[i][k], 1, 5e-3);  // 250 rays against 48 cells
  }
  EXPECT_EQ(a.template_shape(1).name, "flat/grain/1");
  EXPECT_EQ(b.template_shape(1).name, "flat/grain/1");
}

TEST_F(MadeGrains, ADecoderIsHeldOnceBesideNamedShapes) {
  Library known = library_;  // the gate wants figures of shapes that are named
  for (Shape& s : known.shape) s.certificate.falling = 0, s.certificate.euler = 2;
  fs::path const file = file_.string() + ".known.h5";
  write_model(file, known, true);
  GrainsCase named = grains_at("pebbles:flat/0", {{0, 1, 0.2}}, 0.1, 250);
  named.name = "named";
  for (NodeStorage storage : {NodeStorage::explicit_, NodeStorage::compact}) {
    Case c = sampled(1, storage);
    c.library[0].file = file;
    c.grains.push_back(named);
    Simulation s(c, {.threads = 2});
    EXPECT_EQ(s.impl().scene.networks.net.size(), 1u);
    std::vector<Code> const code = codes(s);
    EXPECT_EQ(code[1], library_.shape[0].code);
    EXPECT_NE(code[0], code[1]);
  }
  fs::remove(file);
}

TEST_F(MadeGrains, PlanTellsHowManyWereTriedAndWhyTheOthersWereNotTaken) {
  Case c = sampled(2);
  std::vector<Shape> const shape = make_shapes(library_, c.grains[0], c.limits, c.seed, 0, 2).shape;
  // One bound that the first grain fails and the second passes.
  auto const flatness = [&](int i) {
    Vec3 const size = shape[i].box.max - shape[i].box.min;
    return size.z / std::min(size.x, size.y);
  };
  Interval& wanted = c.grains[0].sample->flatness;
  (flatness(0) < flatness(1) ? wanted.low : wanted.high) = (flatness(0) + flatness(1)) / 2;
  c.grains[0].count = 1;
  c.grains[0].insert.position.resize(1);
  Simulation s(c, {.threads = 2});
  ASSERT_FALSE(s.plan().notes.empty());
  EXPECT_EQ(s.plan().notes[0], "grains 'grain': 2 tries of flat: 1 accepted, rejected: flatness 1");
  EXPECT_EQ(codes(s)[0], shape[1].code);
}

TEST_F(MadeGrains, StepsOfALine) {
  Shape const &from = library_.shape[0], &to = library_.shape[4];
  Simulation alike(on_line(3, 0.5, 0.5), {.threads = 2});
  EXPECT_EQ(alike.impl().scene.shape.size(), 1u);
  EXPECT_EQ(alike.impl().scene.bodies(), 3);
  EXPECT_EQ(alike.impl().scene.template_shape(0).code, interpolate_codes(from, to, 0.5));
  EXPECT_EQ(alike.impl().scene.template_shape(0).name, "flat-long/grain/0");
  std::vector<Code> const even = made(on_line(3, 0, 1));
  ASSERT_EQ(even.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(even[i], interpolate_codes(from, to, 0.5 * i));

  Case c = on_line(3, 0.25, 0.75, true);
  std::vector<Code> const drawn = made(c);
  EXPECT_EQ(std::set<Code>(drawn.begin(), drawn.end()).size(), 3u);
  EXPECT_EQ(made(c, 1), drawn);
  for (Code const& z : drawn) {
    float const t = (z[0] - from.code[0]) / (to.code[0] - from.code[0]);
    EXPECT_TRUE(t >= 0.25f && t <= 0.75f) << t;
    EXPECT_NEAR(z[1], from.code[1] + t * (to.code[1] - from.code[1]), 1e-6);  // codes are floats
  }
  c.seed = 2;
  EXPECT_NE(made(c), drawn);
}

TEST_F(MadeGrains, RefusalsSayWhatThereIs) {
  Case c = sampled(2);
  c.grains[0].sample->category = "flatt";
  expect_refused(c, "no category 'flatt' with latent codes; there are flat, long, gone");
  c.grains[0].sample->category = "gone";
  expect_refused(c, "200 tries gave 0 accepted, rejected: no solid 200");
  c = on_line(2, 0, 1, true);
  c.grains[0].interpolate->from = "flatt/1";
  expect_refused(c, "no shape 'flatt/1' (did you mean 'flat/1'?)");
  c = on_line(3, 0, 1);
  c.grains[0].interpolate->to = "gone/7";
  expect_refused(c,
                 "2 of 3 shapes from 'flat/0' to 'gone/7' do not pass the gate (t = 0.5: no solid, t = 1: no solid)");
  c = on_line(1, 0, 0);
  c.limits.gradient_low = 0.99, c.limits.gradient_high = 1.01;
  expect_refused(c, "(t = 0: gradient)");
}

TEST_F(MadeGrains, NoGrainsDrawNothing) { EXPECT_EQ(Simulation(sampled(0), {}).plan().shapes, 0); }

// A replica's grains are those of the single case with its seed, in both storages; a fixed line is made once.
TEST_F(MadeGrains, EachReplicaHasItsOwn) {
  for (NodeStorage const storage : {NodeStorage::explicit_, NodeStorage::compact}) {
    Case c = sampled(2, storage);
    c.replicas = 2;
    c.time.step = 1e-4;
    c.time.end = 0.002;
    Simulation both(c, {});
    std::vector<Code> const of_both = codes(both);
    ASSERT_GE(of_both.size(), 4u);
    while (both.step() == RunState::running) {
    }
    for (int r = 0; r < 2; ++r) {
      Case alone = c;
      alone.replicas = 1;
      alone.seed = replica_seed(c.seed, r);
      Simulation one(alone, {});
      while (one.step() == RunState::running) {
      }
      for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(of_both[2 * r + i], codes(one)[i]);
        EXPECT_EQ(both.frame().position[2 * r + i], one.frame().position[i]);
      }
    }
    EXPECT_NE(of_both[0], of_both[2]);
  }
  Case line = on_line(3, 0, 1);
  line.replicas = 2;
  EXPECT_EQ(Simulation(line, {}).plan().shapes, 3);
  line.grains[0].interpolate->random = true;
  EXPECT_EQ(Simulation(line, {}).plan().shapes, 6);
}

}  // namespace
}  // namespace scree
