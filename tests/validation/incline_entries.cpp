// incline_entries.cpp: row 7 of the book: a block on an incline at 2 % more and 2 % less friction than holds it.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/support/cases.h"
#include "tests/support/same_state.h"
#include "tests/validation/entries.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr slope = 0.4, gravity = 9.81, diameter = 0.1;  // [rad], [m/s2], [m]

Case block(double mu, Evaluator evaluator) {
  Case c = rock_case();
  c.gravity = Vec3{gravity * std::sin(slope), 0, -gravity * std::cos(slope)};
  c.contact[0].friction = mu;
  c.contact[0].damping_ratio = 0.7;
  double const half_height = 0.5 * diameter * std::cbrt(M_PI / 6 / 4);  // box 2:2:1 of volume pi/6 d^3
  c.grains = {grains_at("box:2:2:1", {{0, 0, half_height - 1e-6}}, diameter, 1000)};
  c.grains[0].evaluator = evaluator;
  c.wall = {floor_at(0)};
  c.time.end = full() ? 4 : 0.2;
  // The load comes on at once and only 4e-4 J move: 0.3 of the critical step leaves 1.03e-3 of that open, and the
  // remainder falls with the square of the step.
  c.time.safety = 0.2;
  return c;
}

// What goes on from a checkpoint of `s` as a file.
void restart_from(Simulation const& s, Simulation& fresh, Flaw const& flaw) {
  std::filesystem::path const file =
      std::filesystem::temp_directory_path() / ("scree_book_" + std::to_string(::getpid()) + ".h5");
  write_checkpoint(file, s.checkpoint());
  Checkpoint checkpoint = read_checkpoint(file);
  std::filesystem::remove(file);
  if (flaw.at_restart) flaw.at_restart(checkpoint);
  fresh.restore(checkpoint);
}

double differing_members(Simulation& a, Simulation& b) {
  std::string const names = differences(a.impl().state, b.impl().state);  // each followed by a blank
  return static_cast<double>(std::count(names.begin(), names.end(), ' '));
}

struct Along {  // the incline, over the last part of a run
  double t = 0, x = 0, v = 0;
};

Along at(Simulation const& s) { return {s.time(), s.frame().position[0].x, s.frame().velocity[0].x}; }

}  // namespace

void block_on_incline(Entry& book, Evaluator evaluator, Flaw const& flaw) {
  std::string const as = ", box as " + evaluator_name(evaluator);
  for (bool const holds : {true, false}) {
    double const mu = (holds ? 1.02 : 0.98) * std::tan(slope);
    Case const c = block(mu, evaluator);
    double const settled = 0.6 * c.time.end;
    Simulation s(c, {}), again(c, {});
    flaw.start(s);
    Along from;
    bool restarted = false;
    while (flaw.step(s) == RunState::running) {
      if (s.time() < settled || from.t > 0) continue;
      from = at(s);
      if (!holds) continue;
      restart_from(s, again, flaw);
      restarted = true;
    }
    Along const to = at(s);
    if (holds) {
      book.at_most("creep at 1.02 of the friction that holds" + as, "d/s",
                   std::abs(to.x - from.x) / (to.t - from.t) / diameter, 1e-6);
      if (!restarted) continue;
      flaw.start(again);
      while (flaw.step(again) == RunState::running) {
      }
      book.absolute("state after a restart half way: members that differ" + as, "", 0, differing_members(s, again), 0);
    } else {
      double const a = gravity * (std::sin(slope) - mu * std::cos(slope));
      book.relative("acceleration at 0.98 of it" + as, "m/s2", a, (to.v - from.v) / (to.t - from.t), 1e-3);
    }
    book.at_most(std::string("ledger residual of the energy moved, ") + (holds ? "holding" : "sliding") + as, "",
                 std::abs(s.ledger().residual) / s.ledger().moved, 1e-3);
  }
}

namespace {

TEST(Validation, Row7BlockOnAnIncline) {
  Entry book("validation", "7", "block on an incline holds or slides", "closed form: Coulomb");
  for (Evaluator evaluator : {Evaluator::analytic, Evaluator::grid, Evaluator::mesh}) block_on_incline(book, evaluator);
}

}  // namespace
}  // namespace scree::book
