// test_generate.cpp: generated shapes: what passes, what is counted, and that only the seed decides.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "shapes/generate.h"
#include "shapes/model_file.h"
#include "shapes/zero_set.h"
#include "tests/support/pebble_decoder.h"

namespace scree {
namespace {

Library const& pebbles() {
  static Library const library = test::pebble_library();
  return library;
}

SampleOptions flat(int count) {
  SampleOptions o;
  o.category = "flat";
  o.count = count;
  o.seed = 11;
  o.limits.cells = 24;
  return o;
}

TEST(Generate, SamplesAreNewNormalisedAndCertified) {
  Generation const made = sample_shapes(pebbles(), flat(3));
  ASSERT_EQ(made.accepted.size(), 3u);
  EXPECT_EQ(std::accumulate(made.count.begin(), made.count.end(), 0), made.tries);
  EXPECT_EQ(made.count[0], 3);
  std::set<std::vector<float>> codes;
  for (Shape const& s : pebbles().shape) codes.insert(s.code);
  Library library;
  library.net = pebbles().net;
  for (Candidate const& c : made.accepted) {
    EXPECT_TRUE(codes.insert(c.shape.code).second) << "a code twice";
    library.shape.push_back(c.shape);
    Certificate const& m = c.shape.certificate;
    EXPECT_EQ(m.components, 1);
    EXPECT_EQ(c.euler, 2);
    EXPECT_EQ(m.seed, 11);
    EXPECT_EQ(m.mae, -1) << "nobody knows the truth";
    EXPECT_EQ(m.source.find("sample of flat, seed 11, try "), 0u);
    EXPECT_TRUE(m.gradient_p1 > 0.5 && m.gradient_p99 < 2 && m.gradient_p1 < m.gradient_p99);
    EXPECT_NEAR(c.form.convexity, 1, 2e-3);  // every pebble is
    EXPECT_LE(c.falling, 0.02);
    EXPECT_GE(c.falling, 0);
  }
  EXPECT_TRUE(problems(library).empty());
  EXPECT_EQ(library.shape[0].name, "flat/0");
  Shape const& s = library.shape[2];
  PhiBatch const phi = fast_phi(library, s);
  MeshMass const mass = zero_set_mass(phi, find_zero_set(phi, {1.1 * s.bounding_radius, 32, 0}));
  EXPECT_NEAR(mass.volume, s.volume, 1e-3 * s.volume);
  EXPECT_LT(norm(mass.centroid), 1e-3);
}

TEST(Generate, OnlyTheSeedDecides) {
  SampleOptions o = flat(3);
  Generation const one = sample_shapes(pebbles(), o);
  o.threads = 3;
  o.count = 2;
  Generation const part = sample_shapes(pebbles(), o);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(part.accepted[i].shape.code, one.accepted[i].shape.code);
    EXPECT_EQ(part.accepted[i].shape.query.shift.x, one.accepted[i].shape.query.shift.x);
    EXPECT_EQ(part.accepted[i].shape.lipschitz, one.accepted[i].shape.lipschitz);
  }
  o.seed = 12;
  o.count = 1;
  EXPECT_NE(sample_shapes(pebbles(), o).accepted[0].shape.code, one.accepted[0].shape.code);
}

TEST(Generate, RejectsAreCountedByReason) {
  SampleOptions o = flat(2);
  Generation const all = sample_shapes(pebbles(), o);
  double const middle = (all.accepted[0].form.flatness + all.accepted[1].form.flatness) / 2;
  o.limits.flatness.low = middle;
  Generation const some = sample_shapes(pebbles(), o);
  EXPECT_GT(some.count[static_cast<int>(Verdict::flatness)], 0);
  for (Candidate const& c : some.accepted) EXPECT_GE(c.form.flatness, middle);
  EXPECT_NE(tally(some.count).find("2 accepted, rejected: flatness "), std::string::npos) << tally(some.count);
}

TEST(Generate, ImpossibleLimitsSayWhatRejected) {
  SampleOptions o = flat(2);
  o.limits.sphericity.high = 0.5;
  o.max_tries = 5;
  try {
    sample_shapes(pebbles(), o);
    FAIL();
  } catch (std::invalid_argument const& e) {
    EXPECT_NE(std::string(e.what()).find("5 tries gave 0 accepted, rejected: sphericity 5"), std::string::npos)
        << e.what();
  }
}

TEST(Generate, EveryGateCloses) {
  CodeFrame const frame = code_frame(pebbles(), 0);
  auto const verdict = [&](std::vector<float> code, ShapeLimits limits = {}) {
    limits.cells = 24;
    return judge_code(pebbles(), frame, std::move(code), limits, "x", "test").verdict;
  };
  EXPECT_EQ(verdict({0, 0.1f}), Verdict::accepted);
  EXPECT_EQ(verdict({8, 8}), Verdict::no_solid);       // the body shrinks to nothing
  EXPECT_EQ(verdict({-3, -3}), Verdict::leaves_ball);  // and grows beyond what was trained
  ShapeLimits limits;
  limits.gradient = {0.5, 0.6};
  EXPECT_EQ(verdict({0, 0.1f}, limits), Verdict::gradient);
  limits = {};
  limits.falling = -1;
  EXPECT_EQ(verdict({0, 0.1f}, limits), Verdict::falling);
  limits = {};
  limits.volume = {2, 3};
  EXPECT_EQ(verdict({0, 0.1f}, limits), Verdict::volume);
  limits = {};
  limits.roundness = {2, 3};
  EXPECT_EQ(verdict({0, 0.1f}, limits), Verdict::roundness);
}

TEST(Generate, LineBetweenTwoShapes) {
  Shape const &a = pebbles().shape[1], &b = pebbles().shape[5];
  ShapeLimits limits;
  limits.cells = 24;
  limits.volume = {};
  std::vector<Candidate> const made = interpolate_shapes(pebbles(), a, b, {0, 0.5, 1}, limits, 2);
  for (Candidate const& c : made) EXPECT_EQ(c.verdict, Verdict::accepted) << c.shape.certificate.source;
  EXPECT_EQ(made[0].shape.code, a.code);
  EXPECT_EQ(made[2].shape.code, b.code);
  // Volume before normalisation changes steadily along the line of these bodies.
  EXPECT_GT((made[1].volume_ratio - made[0].volume_ratio) * (made[2].volume_ratio - made[1].volume_ratio), 0);
}

}  // namespace
}  // namespace scree
