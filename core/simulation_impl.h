// simulation_impl.h: what a Simulation holds; tests look inside.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/contacts.h"
#include "core/simulation.h"
#include "core/time_step.h"
#include "core/watch.h"

namespace scree {

struct Simulation::Impl {
  Case c;
  SimulationOptions options;
  Profile profile;
  Queue queue;
  Scene scene;
  Effects effects;
  ContactSettings contacts;
  StepEstimate estimate;
  State state;
  Workspace work;
  WatchReport report;
  RunState run_state = RunState::running;
  std::vector<std::string> messages;
  bool warned_of_share = false;
  QueryCounts counts_before;  // of what came before the first step
  Box surroundings;           // empty: without walls, or a grain has left and it was said
  MeasureCache measure_cache;
  std::vector<MeasureRow> measure_rows;
  std::vector<Measurement> measure_on_schedule;  // at the end: State::measure without the samples taken because of it
  std::int64_t first_step = 0;                   // of this process: where it was restored

  Impl(Case const& c_, SimulationOptions const& options_, Frame const* start);
  RunState step();
  QueryCounts counts() const;   // since the start of the process
  double gravity_size() const;  // [m/s2]; 9.81 where the case has none

 private:
  void move_walls(double dt);
  [[noreturn]] void stop(std::string const& what) const;
  void check_finite() const;
  void check_overlap() const;
  void check_time_step();
  void check_travel();
  void check_leaving();
  void settle();
};

}  // namespace scree
