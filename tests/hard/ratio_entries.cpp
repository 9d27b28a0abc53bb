// ratio_entries.cpp: large ratios of mass and size: overlaps as the law predicts, hopeless loads refused, near-linear
// search.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <random>

#include "kernels/broad_phase.h"
#include "tests/hard/course.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr gravity = 9.81, density = 2650;
double mass_of(double d) { return density * M_PI / 6 * d * d * d; }
double side_of(double d) { return d * std::cbrt(M_PI / 6); }  // of a cube [m]

// A large cube on four small ones, which stand on the floor, each sunk in as far as its load asks for.
struct Table {
  double large, small;  // diameters [m]
  double kappa;         // [N/m3]
  double foot_overlap() const { return (mass_of(large) / 4 + mass_of(small)) * gravity / (kappa * face()); }  // [m]
  double top_overlap() const { return mass_of(large) / 4 * gravity / (kappa * face()); }
  double face() const { return side_of(small) * side_of(small); }
};

Case table_case(Table const& t) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.contact[0].kappa = t.kappa;
  c.contact[0].damping_ratio = 0.7;
  c.contact[0].friction = 0.5;
  c.limits.overlap = 0.05;
  double const s = side_of(t.small), out = 0.35 * side_of(t.large), z = s / 2 - t.foot_overlap();
  c.grains = {grains_at("box:1:1:1", {{out, out, z}, {-out, out, z}, {out, -out, z}, {-out, -out, z}}, t.small, 4000),
              grains_at("box:1:1:1", {{0, 0, z + s / 2 - t.top_overlap() + side_of(t.large) / 2}}, t.large, 1000)};
  c.grains[1].name = "large";
  c.wall = {floor_at(0)};
  return c;
}

TEST(Hard, HeavyOnSmallStands) {
  Entry book("hard", "mass-ratio", "mass 1:100 on small grains stands; 1:1e6 is refused, and stands with a stiffer law",
             "Winkler face: overlap = N / (kappa A)");
  struct Ratio {
    char const* name;
    double size;     // ratio of diameters
    double load_at;  // overlap of the loaded small grains [d]
    double seconds;
  };
  for (Ratio const& r : {Ratio{"1:100", std::cbrt(100.0), 1e-3, 0.1}, Ratio{"1:1e6", 100, 1e-2, 0.004}}) {
    Table t{0.01 * r.size, 0.01, 0};
    t.kappa = mass_of(t.large) / 4 * gravity / (t.face() * r.load_at * t.small);
    Case c = table_case(t);
    c.time.end = r.seconds;
    Simulation s(c, {});
    double top = 0, foot = 0;
    Course const run = follow(s);
    for (std::size_t k = 0; k < s.impl().work.pair.size(); ++k) {
      PairResult const& p = s.impl().work.result[k];
      (s.impl().work.pair[k].with_plane() ? foot : top) += p.overlap / 4;
    }
    EXPECT_EQ(run.stopped, "");
    std::string const name = std::string("mass ratio ") + r.name;
    // An edge node carries its whole area on either face: 0.83 sqrt(6 / nodes) too much on a cube's, 3 % here.
    book.relative(name + ": overlap of the large grain in its feet", "m", t.top_overlap(), top, 0.05);
    book.relative(name + ": overlap of the feet in the floor", "m", t.foot_overlap(), foot, 0.05);
    book.at_most(name + ": worst overlap", "d", run.overlap, 1.3 * r.load_at);
    book.at_most(name + ": kinetic energy", "m g d", run.kinetic, 1e-4);
  }
}

TEST(Hard, LoadCheckRefusesWhatCannotStand) {
  Entry book("hard", "load-check", "mass ratio 1:1e6 under the default stiffness is refused",
             "load at limits.overlap against weight");
  Table t{1, 0.01, 2e6 / (M_PI * 0.25 * 0.01)};
  Case c = table_case(t);
  for (GrainsCase& g : c.grains)
    for (Vec3& x : g.insert.position) x.z += 0.3;
  std::string why;
  try {
    Simulation s(c, {});
  } catch (InputError const& e) {
    why = e.what();
  }
  EXPECT_TRUE(says(why, "load check") && says(why, "1e+06 times") && says(why, "normal.kappa")) << why;
  book.at_least("refused", "", !why.empty(), 1);
  c.gravity = {};  // nothing weighs anything
  EXPECT_NO_THROW(Simulation(c, {}));
  // Multiplied as the message says, it is taken.
  c.gravity = Vec3{0, 0, -gravity};
  c.contact[0].kappa = 1.01 * mass_of(1) * gravity / (t.face() * c.limits.overlap * t.small);
  EXPECT_NO_THROW(Simulation(c, {}));
}

// Seconds to find the pairs of n boxes in a room that they fill to three tenths: mostly small ones, each decade of size
// with the same volume up to 1 : 10, and one box 100 times the smallest for every 2,000.
double search_seconds(int n, std::size_t& pairs) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  double const least = 0.05;
  std::vector<double> half(n);
  double volume = 0;
  for (int i = 0; i < n; ++i) {
    half[i] = i % 2000 == 0 ? 100 * least : least / std::cbrt(1 - u(random) * (1 - 1e-3));
    volume += 8 * half[i] * half[i] * half[i];
  }
  double const room = std::cbrt(volume / 0.3);
  std::vector<Box> box;
  for (double const h : half) {
    Vec3 const x{room * u(random), room * u(random), room * u(random)};
    box.push_back({x - Vec3{h, h, h}, x + Vec3{h, h, h}});
  }
  std::vector<int> const shape_of(n, 0);
  SceneView scene;
  scene.shape_of = shape_of;
  BroadPhase work;
  Queue queue;
  std::vector<double> seconds;
  for (int k = 0; k < 3; ++k) {
    std::clock_t const start = std::clock();  // of this process: the machine may have other work
    find_pairs(queue, scene, box, {}, work);
    seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  pairs = work.pair.size();
  return *std::min_element(seconds.begin(), seconds.end());
}

TEST(Hard, SizeRatioOfAHundredInOneScene) {
  Entry book("hard", "size-ratio", "broad phase over sizes 1:100 in one scene", "near-linear: n log n");
  int const n = full() ? 100000 : 4000;
  std::size_t few = 0, many = 0;
  double const small = search_seconds(n, few), large = search_seconds(8 * n, many);
  // log(8 n) / log(n) is 1.25; what leaves the caches takes the rest. A search of all pairs would take 8.
  book.at_most("time a box, 8 n over n", "", large / (8 * small), 3);
  book.trend("pairs a box", "", static_cast<double>(many) / (8.0 * n));
}

}  // namespace
}  // namespace scree::book
