// step_meter.h: what time steps from a saved state cost: every round repeats the very same steps.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/simulation_impl.h"

namespace scree {

// Processor time of this process, of all its threads together [s].
double process_seconds();

// Of an odd number of values the middle one, else the upper of the two; 0 of none.
double median(std::vector<double> values);

// What some steps did.
struct StepCounts {
  std::int64_t rebuilt = 0;  // sides whose node list was made anew
  std::int64_t block = 0;    // queries of blocks of nodes
  std::int64_t listed = 0;   // phi queries of nodes, rebuilds of lists included
  std::int64_t active = 0;   // nodes that carry force: phi and its gradient
  std::int64_t again = 0;    // of these evaluated twice, since only the first time showed that they are inside

  std::int64_t queries() const { return block + listed + again; }
};

// A state to start from, and what its rounds took.
struct SteppedScene {
  std::string name;
  int threads = 1;
  State state;
  Workspace work;
  std::vector<double> wall, cpu;         // a round each [s]
  std::map<std::string, double> stages;  // of the last round [s]
  StepCounts counts;                     // of a round, the same each time
};

class StepMeter {
 public:
  // The simulation then goes on for ever without settling. It must outlive this.
  explicit StepMeter(Simulation& simulation);

  // The scene after `steps` steps from `from`: its lists are those of a run that is under way.
  SteppedScene warm(std::string const& name, State const& from, Workspace const& work, int steps);
  // One round of `steps` steps from the scene's state; adds to wall and cpu.
  void measure(SteppedScene& scene, int steps);

  Simulation::Impl& restore(State const& state, Workspace const& work, int threads);

 private:
  Simulation& simulation_;
};

// Every velocity component anew, uniform within +- speed [m/s], the same ones each time.
State flowing(State state, double speed);

// Nodes of the pairs that carry force: of both grains, or of the grain at a wall.
std::int64_t nodes_of_contacting_pairs(Scene const& scene, Workspace const& work);

// A heap to measure: `grains` of these shapes that fall into a box with friction and damping and come to rest.
Case heap_case(std::vector<LibraryCase> const& library, std::vector<std::string> const& shapes, int grains, int nodes,
               double fall);

}  // namespace scree
