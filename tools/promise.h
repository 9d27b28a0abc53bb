// promise.h: whether [accuracy] keeps its word: forces of random settings, as picked, against a dense surface.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/accuracy.h"

namespace scree {

// One kind of grain at one size, stiffness and law, asked for one budget.
struct PromiseSetting {
  std::string shape;  // as a case names it; of a library: "grains:..."
  Evaluator evaluator = Evaluator::net;
  int cells = default_grid_cells;  // of a grid
  ContactLaw law = ContactLaw::winkler;
  double diameter = 0.1;   // [m]
  double stiffness = 2e6;  // [N/m], hertz: E / diameter
  double overlap = 0.01;   // of the contacts [d]
  double budget = 0.01;
};

struct PromiseResult {
  PromiseSetting setting;
  std::string refused;                      // why the budget was refused; empty: it was taken
  int nodes = 0;                            // picked
  double expected = 0;                      // what the pick says of its nodes
  double median = 0, p95 = 0, largest = 0;  // of the contacts' errors
  int within = 0;                           // contacts within the budget
  bool kept() const { return p95 <= setting.budget; }
};

struct PromiseOptions {
  std::filesystem::path library;  // with what "grains:" names; empty: formulas and grids of them only
  int contacts = 40;              // a setting
  AccuracyOptions accuracy;
  StepCosts costs;
};

// Setting `index` of the endless list `seed`, always the same: kinds take turns (ellipsoids and superellipsoids by
// formula, networks, grids of both), sizes 1 mm to 1 m, stiffness 1e5 to 1e8 N/m, contacts 0.3 to 5 % d deep, budgets
// 0.3 to 10 %, all even in their logarithm.
PromiseSetting promise_setting(int seed, int index, bool networks);

// The engine's own forces of contacts drawn with `seed`, that the pick has not seen, with the nodes that it took,
// against the integral over the dense cover of the same phi in double; errors are vectors over |force|.
PromiseResult try_promise(PromiseSetting const& setting, PromiseOptions const& options, std::uint64_t seed);

std::string promise_csv(std::vector<PromiseResult> const& results);

}  // namespace scree
