// accuracy.h: from [accuracy] of a case to node counts and a time step: the cheapest that keep the budget.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case.h"
#include "core/scene.h"

namespace scree {

// What a step costs on this machine, measured once: of ellipsoids by their formula, processor time of one thread.
struct StepCosts {
  std::string machine;          // hash of processor and build: what the figures are good for
  std::vector<int> nodes;       // a grain, ascending
  std::vector<double> us;       // a particle and step [us], and ...
  std::vector<double> queries;  // ... how often it asks for phi
  double query_ns = 0;          // what such a query takes there [ns]

  // A particle-step of grains whose queries take `ns` each [us]; powers of the node count between the measured ones
  // and beyond.
  double particle_step_us(int count, double ns) const;
};

// Time of a query of phi near the surface, of many at once [ns].
double measure_query_ns(Library const& library, Shape const& shape);

// What was picked, and what it is expected to be worth.
struct AccuracyPick {
  struct Entry {
    std::string name;     // of the [[grains]] entry
    int nodes = 0;        // a grain
    bool given = false;   // ... by the case
    double overlap = 0;   // of the contacts that the error is of [d]
    double error = 0;     // of their force, see ContactErrors
    double resting = 0;   // overlap under a grain's own weight [d]; 0: it has none
    double exponent = 2;  // force ~ overlap^exponent
    double shape = -1;    // error of the force from phi of the shape against its source; -1: not known
    int shapes = 0;       // of the entry, and ...
    int measured = 0;     // ... how many of them were measured
    double query_ns = 0;  // of its evaluator [ns]
  };
  std::vector<Entry> entry;
  double budget = 0;
  double safety = 0;
  bool step_given = false;  // safety or the step itself are the case's
  double step_error = 0;    // of a contact's impulse, see impulse_error
  double step = 0;          // expected [s]
  double step_us = 0;       // a particle-step, one thread [us]
  double seconds = 0;       // of the whole run, one thread

  // Largest of the entries' errors and that of the step together.
  double error() const;
};

struct AccuracyOptions {
  int threads = 1;
  int dense_points = 256000;  // of the covers that forces are compared with
  int most_nodes = 64000;     // what may be picked
};

// Measures what the cache does not have: the errors of each entry's shapes (of long lists eight, evenly) and the time
// of their queries. What the case gives stays as it is. Throws InputError where the budget cannot be kept, with the one
// that can, and for everything that is wrong with the case.
AccuracyPick pick_accuracy(Case const& c, StepCosts const& costs, AccuracyOptions const& options);

// The case with what was picked and without [accuracy]: a case like any other.
Case with_pick(Case c, AccuracyPick const& pick);

// What was picked in words, a line each.
std::vector<std::string> pick_in_words(AccuracyPick const& pick);

}  // namespace scree
