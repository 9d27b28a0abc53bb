// measure_kinds.h: what can be measured: one table, a line a kind. See core/measurements.h for when it is.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/state.h"

namespace scree {

// Points inside shapes, made once when the first cut grain of the shape is met (core/measure_packing.cpp).
struct MeasureCache {
  std::map<std::pair<int, int>, std::vector<Vec3>> inside;  // by template and number [d]
};

// All that a measurement looks at. It changes nothing but its own memory.
struct MeasureView {
  MeasureCase const& measure;
  Case const& c;
  Scene const& scene;
  State const& state;
  Workspace const& work;
  MeasureCache& cache;
};

struct Quantity {
  std::string name, unit;
};

// Values of one sample, in the order of the kind's quantities. NaN: undefined at this moment, it enters no mean.
using Values = std::vector<double>;
using Memory = std::vector<double>;

struct MeasureKind {
  char const* name;
  char const* meaning;                          // its quantities and what the keys do to them, Markdown
  std::vector<char const*> required, optional;  // keys, see core/case_measure_text.cpp
  bool region_needed = false;                   // box or cylinder
  std::vector<Quantity> (*quantities)(MeasureView const&);
  Values (*sample)(MeasureView const&, Memory&);
  void (*visit)(MeasureView const&, double dt,
                Memory&) = nullptr;  // after every step, and before the first with dt = 0; null: looks when due only
  bool interval = false;             // values belong to the time since the previous sample
  std::string (*check)(Case const&, MeasureCase const&) = nullptr;  // what is wrong with the keys together; empty: good
};

std::vector<MeasureKind> const& measure_kinds();
MeasureKind const* find_measure_kind(std::string const& name);  // null: there is none
MeasureKind const& measure_kind(std::string const& name);       // throws std::logic_error: check_measures saw to it

// Unit vector against gravity; +z without it.
Vec3 up_of(Case const& c);

// Largest d of the case's grains [m].
double largest_diameter(Scene const& scene);

}  // namespace scree
