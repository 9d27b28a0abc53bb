// time_step_entries.cpp: time steps of 0.5 to 5 critical ones on a sphere, stacks and tight boxes.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "kernels/contact_reduce.h"
#include "tests/hard/course.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr gravity = 9.81, d = 0.1;
double const side = d * std::cbrt(M_PI / 6), kappa = 2e6 / (M_PI * 0.025 * 1e-3);

// Scenes in contact from the start, without anything that would hide growth: no damping, no friction.
std::map<std::string, Case> scenes() {
  std::map<std::string, Case> out;
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.wall = {floor_at(0)};
  c.grains = {grains_at("sphere", {{0, 0, 0.5 * d - 5e-5}}, d)};
  out["sphere on a plane"] = c;
  c.grains = {grains_at("box:1:1:1", {}, d, 300)};
  for (int i = 0; i < 4; ++i) c.grains[0].insert.position.push_back({0, 0, (i + 0.5) * side - 3e-6 * (i + 1)});
  c.grains[0].count = 4;
  out["stack of blocks"] = c;
  double const half = side / 2 - 2e-5;  // tighter than the block by 4e-4 d
  c.grains = {grains_at("box:1:1:1", {{0, 0, 0}}, d, 300)};
  c.wall = {open_box({-half, -half, -half}, {half, half, half})};
  c.wall[0].open = {};
  out["block in a tight box"] = c;
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 0}}, d, 300)};
  double const a = 0.5 * d / std::cbrt(0.48);
  c.wall[0].min = Vec3{-a, -0.8 * a, -0.6 * a} * 0.998, c.wall[0].max = Vec3{a, 0.8 * a, 0.6 * a} * 0.998;
  out["stone in a tight box"] = c;
  return out;
}

std::string fmt_share(double share) {
  std::string text = std::to_string(share);
  return " at " + text.substr(0, 4) + " critical steps";
}

double critical_of(Case c) {
  c.time.step = 1e-12, c.time.end = 1e-11;
  Simulation s(c, {});
  Simulation::Impl& i = s.impl();
  return critical_time_step(i.scene.view(), i.work.pair, i.work.result, i.work.in_contact, i.work.rolling,
                            i.state.wrench.stiffness);
}

TEST(Hard, TimeStepsAroundTheCriticalOne) {
  Entry book("hard", "time-step", "0.5, 1, 2 and 5 critical steps, automatic steps",
             "stable to 1, stopped above; never NaN");
  for (auto const& [name, base] : scenes()) {
    double const critical = critical_of(base);
    ASSERT_TRUE(std::isfinite(critical)) << name;
    for (double share : {0.5, 0.98, 2.0, 5.0}) {
      Case c = base;
      c.time.step = share * critical;
      c.time.end = (full() ? 100000 : 2000) * *c.time.step;
      Simulation s(c, {});
      double const start = mechanical_energy(s.ledger()), scale = s.ledger().elastic_normal;
      double early = 0, late = 0;
      Course const run = follow(s, [&] {
        // Of the energy moved so far: blocks without friction slide off each other in the end, and fall.
        LedgerRow const row = s.ledger();
        double const off = std::abs(mechanical_energy(row) - start) / std::max(scale, row.moved);
        double& largest = s.time() < c.time.end / 2 ? early : late;
        largest = std::max(largest, off);
      });
      EXPECT_TRUE(run.finite) << name << " at " << share;
      std::string const which = name + fmt_share(share);
      if (share < 1) {
        // Contacts may stiffen while it runs, as more nodes come in: then the same step is above 1, and the message
        // says so.
        if (!run.stopped.empty()) {
          EXPECT_TRUE(says(run.stopped, "of the critical step")) << which << run.stopped;
        }
        if (run.stopped.empty())
          book.at_most(which + ": energy error, second half over the first", "", late / early, 1.5);
      } else {
        EXPECT_TRUE(says(run.stopped, "of the critical step")) << which << ": " << run.stopped;
        book.at_most(which + ": steps before it was stopped", "", static_cast<double>(s.steps()), 2);
      }
    }
    Case c = base;
    c.time.end = 0.02;
    Simulation s(c, {});
    Course const run = follow(s);
    EXPECT_EQ(run.stopped, "") << name;
    EXPECT_TRUE(run.finite);
    book.at_most(name + ", automatic: share of the critical step at the start", "", s.time_step() / critical, 1);
    book.at_most(name + ", automatic: not accounted for, of the elastic energy at the start", "",
                 std::abs(run.residual) / Simulation(base, {}).ledger().elastic_normal, 1e-2);
  }
}

}  // namespace
}  // namespace scree::book
