// entries.h: what entries and the tests that sabotage them share: the same function, with and without a flaw.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/checkpoint.h"
#include "core/simulation_impl.h"
#include "tests/validation/book.h"

namespace scree::book {

// Wrong physics, put into a run from outside. Without any: the run as it is.
struct Flaw {
  std::function<void(Simulation::Impl&)> at_start = nullptr;    // once, before the first step
  std::function<void(Simulation::Impl&)> after_step = nullptr;  // every step
  std::function<void(Checkpoint&)> at_restart = nullptr;        // between writing and reading it

  void start(Simulation& s) const {
    if (at_start) at_start(s.impl());
  }
  RunState step(Simulation& s) const {
    RunState const state = s.step();
    if (after_step) after_step(s.impl());
    return state;
  }
};

// How the same body answers for phi, in words for a figure: "formula", "grid" ...
std::string evaluator_name(Evaluator evaluator);

// Row 7. A block on an incline at 1.02 and 0.98 of the friction that holds it; the one that holds is stopped half way
// and goes on from its checkpoint.
void block_on_incline(Entry& book, Evaluator evaluator, Flaw const& flaw = {});

// Row 7a. One body dropped on a plane along one of its axes.
struct Rebound {
  std::string shape = "ellipsoid:1:1:1";
  double reach = 0.5;  // of the body below its centroid [d]
  double zeta = 0.4, expected = 0.357, speed = 1;
  int nodes = 1000;
  Evaluator evaluator = Evaluator::net;
};
double rebound(Rebound const& r, Flaw const& flaw = {});  // speed after over speed before
void add_rebound(Entry& book, std::string const& what, Rebound const& r, Flaw const& flaw = {});

// Row 7b. `transport` as in kernels/tangential.h.
using Transport = std::function<Vec3(Vec3 xi, Mat3 const& turn, Vec3 normal)>;
void history_turns_with_the_pair(Entry& book, Transport const& transport);

// Row 7d. Two grains of a shape pushed into each other until their centres meet, from several sides. allowed: what the
// energy may fall by on the way in, as a share of its largest.
void energy_of_approach(Entry& book, std::string const& name, GrainsCase const& grain,
                        std::vector<LibraryCase> const& library, double allowed, Flaw const& flaw = {});

// Row 8. Frictionless, undamped encounters of two grains; poses are drawn by `seed`.
struct Encounter {
  std::string shape_a, shape_b;
  std::vector<LibraryCase> library;
  unsigned seed = 0;
  double speed = 1;     // of each grain [m/s]
  double safety = 0.3;  // as in a case
  Evaluator evaluator = Evaluator::net;
  NodeStorage storage_a = NodeStorage::explicit_, storage_b = NodeStorage::explicit_;
};
// Adds the worst of the encounters. kinetic: what is allowed of a relative change of the kinetic energy.
void frictionless_collisions(Entry& book, std::string const& name, std::vector<Encounter> const& encounters,
                             double kinetic, Flaw const& flaw = {});
// A convex, smooth body whose |grad phi| runs from about 0.5 to 1.5, as the model file `name:warped`; written once.
LibraryCase warped_library();

}  // namespace scree::book
