// broad_phase_test.cpp: the hierarchy against all pairs, at every size ratio; and the sort and scan below it.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/broad_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "kernels/base/sort_scan.h"

namespace scree {
namespace {

std::vector<Box> random_boxes(int n, double size_ratio, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Box> boxes;
  for (int i = 0; i < n; ++i) {
    Vec3 const c{u(random), u(random), u(random)};
    double const h = 0.1 / std::cbrt(n) * std::pow(size_ratio, u(random));
    boxes.push_back({c - Vec3{h, h, h}, c + Vec3{h, 2 * h, h}});
  }
  return boxes;
}

bool touch(Box const& a, Box const& b) {
  for (int k = 0; k < 3; ++k)
    if (a.min[k] > b.max[k] || b.min[k] > a.max[k]) return false;
  return true;
}

std::vector<Pair> brute_force(std::vector<Box> const& boxes, std::vector<PlaneRecord> const& planes) {
  std::vector<Pair> pairs;
  for (int a = 0; a < static_cast<int>(boxes.size()); ++a) {
    for (int p = 0; p < static_cast<int>(planes.size()); ++p) {
      double lowest = 1e300;
      for (int corner = 0; corner < 8; ++corner) {
        Vec3 x;
        for (int k = 0; k < 3; ++k) x[k] = corner >> k & 1 ? boxes[a].max[k] : boxes[a].min[k];
        lowest = std::min(lowest, dot(planes[p].normal, x - planes[p].point));
      }
      if (lowest <= 0) pairs.push_back({a, -1 - p});
    }
    for (int b = a + 1; b < static_cast<int>(boxes.size()); ++b)
      if (touch(boxes[a], boxes[b])) pairs.push_back({a, b});
  }
  return pairs;
}

TEST(BroadPhase, FindsExactlyTheOverlappingPairs) {
  std::vector<PlaneRecord> const planes = {{{0, 0, 0.1}, {0, 0, 1}}, {{0.9, 0, 0}, normalized(Vec3{-1, 0.2, 0})}};
  SceneView scene;
  scene.plane = planes;
  BroadPhase work;
  for (int n : {0, 1, 2, 3, 7, 64, 65, 1000})
    for (double ratio : {1.0, 10.0, 100.0}) {
      std::vector<Box> const boxes = random_boxes(n, ratio, n + 1);
      find_pairs({}, scene, boxes, {}, work);
      EXPECT_EQ(work.pair, brute_force(boxes, planes)) << n << " boxes, ratio " << ratio;
    }
}

// Of many worlds, of few, and of some without bodies.
TEST(BroadPhase, BodiesOfDifferentWorldsNeverPair) {
  for (int n : {1, 2, 65, 1000})
    for (int worlds : {1, 2, 3, 50, 100000}) {
      std::vector<Box> const boxes = random_boxes(n, 100, n);
      std::vector<int> world;
      for (int i = 0; i < n; ++i) world.push_back(static_cast<int>((i * 7919L) % worlds));
      SceneView scene;
      scene.world_of = world;
      BroadPhase work;
      find_pairs({.threads = 2}, scene, boxes, {}, work);
      std::vector<Pair> expected = brute_force(boxes, {});
      std::erase_if(expected, [&](Pair p) { return world[p.a] != world[p.b]; });
      EXPECT_EQ(work.pair, expected) << n << " boxes, " << worlds << " worlds";
    }
}

TEST(BroadPhase, BallsTakeOutPairsThatMeetAtCornersOnly) {
  for (int n : {2, 65, 1000}) {
    std::vector<Box> const boxes = random_boxes(n, 10, n + 7);
    std::vector<Vec3> centre;
    std::vector<double> radius;
    for (Box const& b : boxes) {  // not at the middle: a body's box need not be about its centroid
      centre.push_back(b.min * 0.4 + b.max * 0.6);
      radius.push_back(0.5 * (b.max.y - b.min.y));
    }
    BroadPhase work;
    find_pairs({}, {}, boxes, {centre, radius}, work);
    std::vector<Pair> const all = brute_force(boxes, {});
    std::vector<Pair> expected = all;
    std::erase_if(expected, [&](Pair p) { return norm(centre[p.a] - centre[p.b]) > radius[p.a] + radius[p.b]; });
    EXPECT_EQ(work.pair, expected) << n << " boxes";
    if (n == 1000) {
      EXPECT_LT(expected.size(), all.size());
    }
  }
}

TEST(BroadPhase, CoincidentBoxesAllPair) {
  std::vector<Box> const boxes(20, Box{{0, 0, 0}, {1, 1, 1}});
  BroadPhase work;
  find_pairs({}, {}, boxes, {}, work);
  EXPECT_EQ(work.pair.size(), 20u * 19 / 2);
}

TEST(BroadPhase, DoesNotDependOnThreads) {
  std::vector<Box> const boxes = random_boxes(20000, 20, 3);
  BroadPhase one, two;
  find_pairs({.threads = 1}, {}, boxes, {}, one);
  find_pairs({.threads = 2}, {}, boxes, {}, two);
  EXPECT_GT(one.pair.size(), 100u);
  EXPECT_EQ(one.pair, two.pair);
}

TEST(SortScan, SortsStablyAndSums) {
  std::mt19937 random(1);
  for (int n : {0, 1, 100, 50000}) {
    std::vector<std::uint64_t> key(n);
    for (auto& k : key) k = random() % 1000;
    std::vector<int> value(n), expected(n), sum(n + 1);
    std::iota(value.begin(), value.end(), 0);
    expected = value;
    std::vector<std::uint64_t> const original = key;
    std::stable_sort(expected.begin(), expected.end(), [&](int a, int b) { return original[a] < original[b]; });
    sort_by_key({.threads = 2}, key, value);
    EXPECT_EQ(value, expected);
    exclusive_scan({}, value, sum);
    EXPECT_EQ(sum[n], std::accumulate(value.begin(), value.end(), 0));
    if (n > 1) {
      EXPECT_EQ(sum[1], value[0]);
    }
  }
  std::vector<int> two(2), wrong(2);
  EXPECT_THROW(exclusive_scan({}, two, wrong), std::invalid_argument);
}

}  // namespace
}  // namespace scree
