// pile_tiles_test.cpp: copies of a pile side by side do what the pile does, and the bound on a step's ways is one.
// SPDX-License-Identifier: Apache-2.0
#include "tools/pile_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/simulation_impl.h"
#include "core/travel.h"
#include "tools/step_meter.h"

namespace scree {
namespace {

Pile small_pile() { return settle_pile(pile_case(heap_case({}, {"sphere"}, 4, 100, 1)), 1); }

int contacts(Simulation& s) {
  auto const& result = s.impl().work.result;
  return static_cast<int>(
      std::count_if(result.begin(), result.end(), [](PairResult const& r) { return r.active > 0; }));
}

TEST(PileTiles, EveryTileHasTheContactsOfThePileAndNoneWithAnother) {
  int constexpr tiles = 5;
  Pile const pile = small_pile();
  Simulation one(tiled_case(pile, 1, false, 1), {}), many(tiled_case(pile, tiles, true, 1), {});
  ASSERT_EQ(one.bodies(), 4);
  ASSERT_EQ(many.bodies(), 4 * tiles);
  EXPECT_GE(contacts(one), 4);  // all of them have fallen to the floor
  EXPECT_EQ(contacts(many), tiles * contacts(one));
  EXPECT_NEAR(many.largest_overlap(), one.largest_overlap(), 1e-9);  // of rounding, metres from the origin
  // At rest among copies as alone: energy a tile after some steps.
  for (int k = 0; k < 20; ++k) one.step(), many.step();
  EXPECT_NEAR(many.ledger().potential, tiles * one.ledger().potential, 1e-9 * many.ledger().potential);
  EXPECT_LT(many.largest_kinetic_per_grain(), 0.1);
}

TEST(PileTiles, BodiesAreShuffledAndNoneIsLost) {
  Pile const pile = small_pile();
  Case const ordered = tiled_case(pile, 3, false, 1), shuffled = tiled_case(pile, 3, true, 1);
  auto const places = [](Case const& c) {
    std::vector<std::pair<double, double>> out;
    for (Vec3 const& x : c.grains[0].insert.position) out.emplace_back(x.x, x.y);
    return out;
  };
  auto a = places(ordered), b = places(shuffled);
  EXPECT_NE(a, b);
  std::sort(a.begin(), a.end()), std::sort(b.begin(), b.end());
  EXPECT_EQ(a, b);
}

// Over a decade of speeds about the one at which two grains approach by the largest way allowed.
TEST(Travel, WithoutAFastBodyNoPairGoesFar) {
  Pile two{pile_case(heap_case({}, {"ellipsoid:1:0.8:0.6"}, 2, 100, 1)), {}, {}, {0, 0}, {{0, 0, 0}, {0.3, 0.2, 0.2}}};
  two.position = {{0, 0, 0.1}, {0.125, 0, 0.1}};
  two.orientation = {Quat{1, 0, 0, 0}, Quat{1, 0, 0, 0}};
  Simulation s(tiled_case(two, 1, false, 1), {});
  Simulation::Impl& impl = s.impl();
  int far = 0, near = 0;
  double const step = impl.state.time_step, thin = least_half_thickness(impl.scene);
  for (double share = 0.1; share < 10; share *= 1.1) {
    for (std::size_t i = 0; i < impl.state.velocity.size(); ++i)
      impl.state.velocity[i] = Vec3{i % 2 ? 0.5 : -0.5, 0, 0} * (share * largest_travel * thin / step);
    bool const is_far = largest_pair_travel(impl.scene, impl.state, impl.work.pair).share > largest_travel;
    bool const may = pairs_may_travel_far(impl.scene, impl.state);
    EXPECT_TRUE(may || !is_far) << share;
    ++(is_far ? far : near);
    // All have the same speed: the bound is nearly that of a pair.
    if (share < 0.9) {
      EXPECT_FALSE(may) << share;
    }
  }
  EXPECT_GT(far, 0);
  EXPECT_GT(near, 0);
}

}  // namespace
}  // namespace scree
