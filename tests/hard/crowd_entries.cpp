// crowd_entries.cpp: thousands of collisions in one step, no grain, one grain, grains outside and grains that leave.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard/course.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr d = 0.02, gravity = 9.81;

TEST(Hard, ThousandsCollideInOneStep) {
  Entry book("hard", "crowd", "thousands of pairs meet in the same step", "each pair swaps its velocities, undamped");
  int const n = full() ? 20 : 12;  // pairs along an edge
  Case c = rock_case();
  std::vector<Vec3> low, high;
  double const gap = 1e-5;  // the pairs have this left to travel
  for (int i = 0; i < n * n * n; ++i) {
    Vec3 const at = Vec3{double(i % n), double(i / n % n), 1.5 * (i / n / n)} * (1.5 * d);
    low.push_back(at), high.push_back(at + Vec3{0, 0, d + gap});
  }
  c.grains = {grains_at("ellipsoid:1:1:1", low, d, 100), grains_at("ellipsoid:1:1:1", high, d, 100)};
  c.grains[0].insert.velocity = {0, 0, 0.5};
  c.grains[1].name = "upper";
  c.grains[1].insert.velocity = {0, 0, -0.5};
  c.time.end = 3e-3;
  Simulation s(c, {});
  std::size_t largest_jump = 0, before = 0, most = 0;
  Course const run = follow(s, [&] {
    std::size_t touching = 0;
    for (PairResult const& r : s.impl().work.result) touching += r.overlap > 0;
    if (touching > before) largest_jump = std::max(largest_jump, touching - before);
    before = touching, most = std::max(most, touching);
  });
  add_sound_rows(book, "pairs", run, 1e-3, 1e-3);
  int const pairs = n * n * n;
  book.absolute("contacts that began in one step", "", pairs, static_cast<double>(largest_jump), 0);
  book.absolute("contacts at once", "", pairs, static_cast<double>(most), 0);
  int swapped = 0;
  double differ = 0;
  Frame const f = s.frame();
  for (int i = 0; i < pairs; ++i) {
    swapped += f.velocity[i].z < 0 && f.velocity[pairs + i].z > 0;
    differ = std::max(differ, norm(f.velocity[i] - f.velocity[0]));
  }
  book.absolute("pairs that parted again", "", pairs, swapped, 0);
  // Where the same two grains meet at other places, differences of positions round differently.
  book.at_most("largest difference between any two", "m/s", differ, 1e-6);
}

TEST(Hard, NoGrainOneGrain) {
  Entry book("hard", "none-one", "no grain; one grain", "free fall");
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.wall = {floor_at(0)};
  c.time.end = 0.1;
  Simulation none(c, {});
  Course const empty = follow(none);
  EXPECT_EQ(empty.stopped, "");
  EXPECT_EQ(none.state(), RunState::ended);
  EXPECT_TRUE(none.frame().position.empty());
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 1}}, d, 100)};
  Simulation one(c, {});
  Course const run = follow(one);
  EXPECT_EQ(run.stopped, "");
  book.absolute("no grain: energy moved", "J", 0, none.ledger().moved, 0);
  book.relative("one grain: fallen", "m", 0.5 * gravity * one.time() * one.time(), 1 - one.frame().position[0].z, 1e-9);
}

TEST(Hard, OutsideAndLeaving) {
  Entry book("hard", "outside", "grains that start outside the walls, and grains that leave",
             "messages name the grain");
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.limits.overlap = 0.05;
  c.contact[0].damping_ratio = 0.5;
  c.wall = {open_box({0, 0, 0}, {0.2, 0.2, 0.2})};
  c.time.end = 0.05;
  // Behind a wall: inside its solid.
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0.1, 0.1, 0.05}, {0.5, 0.1, 0.1}}, d, 100)};
  std::string refused;
  try {
    Simulation behind(c, {});
  } catch (InputError const& e) {
    refused = e.what();
  }
  bool const named = says(refused, "grain 2") && says(refused, "wall 'container'");
  book.at_least("behind a wall: refused by the names of grain and wall", "", named, 1);
  // Over the open top and beside it: falls for ever, says so once, and the grain that stays is not disturbed.
  c.wall[0].open = {"+z", "-x"};
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0.1, 0.1, 0.05}}, d, 100)};
  Case both = c;
  both.grains[0].insert.position.push_back({-0.3, 0.1, 0.1});
  both.grains[0].insert.velocity = {0, 0, 0};
  both.grains[0].count = 2;
  both.wall = {c.wall[0]};
  both.wall[0].open = {"+z", "-x", "-z"};
  both.wall.push_back(floor_at(0));
  both.wall[1].name = "ground";
  both.wall[1].kind = WallKind::box;
  both.wall[1].inside = false;
  both.wall[1].min = {0, 0, -0.1}, both.wall[1].max = {0.2, 0.2, 0};
  both.time.end = 0.8;
  both.time.step = 1e-5;
  Simulation leaving(both, {});
  Course const run = follow(leaving);
  EXPECT_EQ(run.stopped, "");
  EXPECT_TRUE(says(run.said, "grain 1") && says(run.said, "left")) << run.said;
  book.relative("leaving: fallen freely", "m", 0.5 * gravity * 0.64, 0.1 - leaving.frame().position[1].z, 1e-3);
  both.grains[0].insert.position.pop_back();
  both.grains[0].count = 1;
  Simulation alone(both, {});
  follow(alone);
  EXPECT_EQ(alone.frame().position[0], leaving.frame().position[0]);
  book.at_most("the grain that stays, with and without the other", "m",
               norm(alone.frame().position[0] - leaving.frame().position[0]), 0);
}

}  // namespace
}  // namespace scree::book
