// relax_entries.cpp: grains that start inside each other are pushed apart by `relax`: bounded, finite, never stuck.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/hard/course.h"
#include "tests/support/same_state.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr d = 0.1;  // [m]

struct Start {
  char const* name;
  char const* shape;
  std::vector<Vec3> position;
  std::vector<Quat> orientation;
};

std::vector<Start> starts() {
  double const h = std::sqrt(0.5);
  Quat const across{h, h, 0, 0}, upright{h, 0, h, 0};
  double const plate_end = 0.3 * d;
  return {
      {"two spheres, half overlapped", "sphere", {{0, 0, 0}, {0.5 * d, 0, 0}}, {}},
      {"two ellipsoids, half overlapped", "ellipsoid:1:0.8:0.6", {{0, 0, 0}, {0, 0, 0.3 * d}}, {}},
      {"two boxes, half overlapped", "box:1:1:1", {{0, 0, 0}, {0.4 * d, 0, 0}}, {}},
      {"two boxes at one centre", "box:1:1:1", {{}, {}}, {}},
      {"two spheres at one centre", "sphere", {{}, {}}, {}},
      {"three boxes at one centre", "box:1:1:1", {{}, {}, {}}, {}},
      {"crossed plates, symmetric", "box:10:10:1", {{}, {}}, {Quat{}, across}},
      {"three plates, each across the others", "box:10:10:1", {{}, {}, {}}, {Quat{}, across, upright}},
      {"needle through a plate's end", "box:1:1:10", {{}, {plate_end, 0, 0}}, {Quat{}, upright}},
  };
}

Case case_of(Start const& start, bool relaxed) {
  Case c = rock_case();
  c.grains = {grains_at(start.shape, start.position, d, 500)};
  c.grains[0].insert.quaternion = start.orientation;
  c.limits.overlap = 0.05;
  c.time.end = 0.02;
  if (relaxed) c.relax = RelaxCase{};
  return c;
}

TEST(Hard, OverlappingStartsAreRelaxed) {
  Entry book("hard", "relax", "starting overlaps of half a diameter, equal places, symmetric poses",
             "relax.overlap of the case");
  for (Start const& start : starts()) {
    Case const c = case_of(start, true);
    Simulation s(c, {});
    std::string const said = s.messages().at(0);
    EXPECT_TRUE(says(said, "relax: ") && says(said, " removed ")) << said;
    std::string const name = start.name;
    book.at_most(name + ": overlap left", "d", s.largest_overlap(), c.relax->overlap);
    Frame const f = s.frame();
    double nearest = 1e300, furthest = 0;
    for (std::size_t i = 0; i < f.position.size(); ++i) {
      furthest = std::max(furthest, norm(f.position[i]) / d);
      for (std::size_t j = i + 1; j < f.position.size(); ++j)
        nearest = std::min(nearest, norm(f.position[i] - f.position[j]) / d);
    }
    book.at_least(name + ": distance of centres", "d", nearest, 0.1);
    book.at_most(name + ": furthest that one was pushed", "d", furthest, 3);
    // What is left stored in a flat face of area d^2 / 2: kappa A overlap^2 / 2 = m v^2 for the two of them.
    double const kappa = 2e6 / (M_PI * 0.025 * 1e-3), mass = 2650 * M_PI / 6 * d * d * d;
    double const throws = c.relax->overlap * d * std::sqrt(kappa * d * d / 4 / mass);
    if (full() || start.position[0] == start.position[1]) {
      Simulation again(c, {.threads = 2});
      EXPECT_EQ(differences(s.impl().state, again.impl().state), "") << name << ": not deterministic";
    }
    Course const run = follow(s);
    double fastest = 0;
    for (Vec3 const& v : s.frame().velocity) fastest = std::max(fastest, norm(v));
    book.at_most(name + ": speed at which they leave", "m/s", fastest, throws);
    EXPECT_EQ(run.stopped, "");
    EXPECT_TRUE(run.finite);
  }
}

TEST(Hard, OverlappingStartsAreStoppedWithoutRelax) {
  Entry book("hard", "relax-off", "a starting overlap without relax is stopped at once", "limits.overlap");
  Simulation s(case_of(starts()[2], false), {});
  Course const run = follow(s);
  EXPECT_TRUE(says(run.stopped, "grain 0") && says(run.stopped, "grain 1")) << run.stopped;
  book.at_most("steps before the stop", "", static_cast<double>(s.steps()), 1);
}

TEST(Hard, RelaxRefusesWhatHasNoRoom) {
  Entry book("hard", "relax-full", "relax refuses grains that have no room", "names the deepest pair");
  Case c = case_of({"full", "box:1:1:1", {{0.01, 0, 0}, {-0.01, 0, 0}}, {}}, true);
  c.wall = {open_box({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05})};
  c.wall[0].open = {};
  c.relax->passes = 300;
  std::string why;
  try {
    Simulation s(c, {});
  } catch (InputError const& e) {
    why = e.what();
  }
  EXPECT_TRUE(says(why, "no room")) << why;
  EXPECT_TRUE(says(why, "grain ")) << why;
  book.at_least("refused", "", !why.empty(), 1);
}

}  // namespace
}  // namespace scree::book
