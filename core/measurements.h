// measurements.h: when [[measure]] entries are taken, and their means. They read the state and never change it.
// Samples are taken after the step that comes nearest to k x every, k = 1, 2, ..., and after the last step.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/measure_kinds.h"
#include "core/measure_stress.h"
#include "core/results.h"

namespace scree {

struct MeasureRow {                 // one sample
  int measure = 0;                  // of the case
  double time = 0;                  // [s]
  Values value;                     // in the order of quantities_of
  std::vector<ContactRow> contact;  // with the key `contacts`
  bool off_schedule = false;        // taken because the run ends: a run that is prolonged does not have it
};

std::vector<Quantity> quantities_of(Case const& c, Scene const& scene, State const& state, Workspace const& work,
                                    int measure);

// Sizes state.measure and notes where everything is; contacts have been evaluated.
void start_measurements(Case const& c, Scene const& scene, Workspace const& work, State& state);

// After a step of `dt`. Due samples are appended to `rows` and enter the means.
void take_measurements(Case const& c, Scene const& scene, Workspace const& work, double dt, State& state,
                       MeasureCache& cache, std::vector<MeasureRow>& rows);
// After that, when no other step follows: samples of what was not due.
void take_last_measurements(Case const& c, Scene const& scene, Workspace const& work, double dt, State& state,
                            MeasureCache& cache, std::vector<MeasureRow>& rows);

std::vector<MeasureSummary> summarise_measurements(Case const& c, Scene const& scene, State const& state,
                                                   Workspace const& work);

}  // namespace scree
