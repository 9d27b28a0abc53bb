// simulation.h: one run: builds Scene and State from a Case and steps it. The host owns time step, sequence and commit.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/case.h"
#include "core/measurements.h"
#include "core/query_counts.h"
#include "core/results.h"
#include "kernels/base/profile.h"
#include "kernels/network_device.h"

namespace scree {

struct Checkpoint;  // core/checkpoint.h

// A watch stopped the run: body, step, time and reason are in the message; the state is still readable.
class WatchStop : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SimulationOptions {
  int threads = 1;
  bool brute_force = false;               // test oracle: every node of every touching pair is evaluated at every step
  std::optional<double> skin_steps = {};  // of node_gather.h: changes what a step costs, not one bit of its result
  std::shared_ptr<NetworkDevice> network_device = nullptr;  // evaluates the networks (hybrid mode); null: the host does
};

// What a case costs before it runs: `scree plan` prints it and tests assert it.
struct Plan {
  struct Array {
    std::string name;
    std::int64_t bytes = 0;
  };
  std::vector<std::string> stages;   // in order of execution, e.g. {"bounds", "broad_phase", ...}
  std::vector<std::string> effects;  // e.g. {"gravity", "friction"}
  std::string law;                   // one line a material pair
  std::vector<Array> arrays;
  int bodies = 0, shapes = 0, networks = 0, nodes_max = 0;
  double step = 0;                 // [s]
  std::int64_t steps = 0;          // to time.end
  std::vector<std::string> notes;  // warnings and the load check
};

enum class RunState { running, at_rest, ended };

class Simulation {
 public:
  // Reads the model files the case names. Throws InputError for everything wrong with the case.
  Simulation(Case const& c, SimulationOptions const& options);
  // The same run from the poses and velocities of `start` instead of the case's own, at time 0 and without contact
  // history; the time step is still the one the case asks for. Throws InputError, also for another number of bodies.
  Simulation(Case const& c, SimulationOptions const& options, Frame const& start);
  ~Simulation();

  Plan plan() const;
  RunState step();  // one time step; throws WatchStop
  RunState state() const;
  std::string phase() const;  // "running", "settling", "releasing"
  double time() const;        // [s]
  double time_step() const;   // [s]
  std::int64_t steps() const;
  std::int64_t own_steps() const;  // without those before a restart
  int bodies() const;
  ResultsHeader results_header() const;
  Frame frame() const;  // synchronised velocities
  LedgerRow ledger() const;
  double largest_overlap() const;            // [d] at the nodes, last step
  double largest_kinetic_per_grain() const;  // [m g d] (with g = 9.81 where the case has no gravity), last step
  Profile const& profile() const;
  QueryCounts query_counts() const;                             // of the steps of this process
  std::vector<Quantity> measure_quantities(int measure) const;  // of [[measure]] entry `measure`
  std::vector<MeasureRow> measure_rows();                       // samples taken since the last call
  std::vector<MeasureSummary> measure_summary() const;          // empty without [[measure]]
  // All that is needed to go on with the same bits; `output` is the caller's to fill in.
  Checkpoint checkpoint() const;
  // Go on from there: every later State equals that of the run which was never stopped, bit by bit, for any number of
  // threads. Throws InputError for a checkpoint of another case or of contradictory content; this object is then void.
  void restore(Checkpoint const& checkpoint);
  std::vector<std::string> messages();  // what happened since the last call (time step halved, lists grown ...)

  struct Impl;
  Impl& impl() { return *impl_; }  // for tests

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace scree
