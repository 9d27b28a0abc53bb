// cost_meters.h: the sweeps of `scree cost`: single queries, pairs of grains, a heap at rest and flowing, effects.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tools/cost_scene.h"
#include "tools/step_meter.h"

namespace scree {

// Points at which phi and its gradient are known.
struct QueryPoints {
  std::vector<Vec3> point;  // body frame [d]
  std::vector<double> phi;  // exact [d]
  std::vector<Vec3> gradient;
};
// Within `spread` [d] of the truth's surface and inside its bounding sphere, up to `count`; with 0 on the surface.
QueryPoints truth_points(int count, double spread);

// Of the engine's own queries, one thread.
struct QueryRow {
  std::string subject;
  double phi_mean = 0, phi_largest = 0;    // |phi - exact| at the points of the band [d]
  double normal_mean = 0, normal_p95 = 0;  // angle to the exact normal on the surface [degrees]
  double phi_ns = 0, gradient_ns = 0;      // a query of phi, of phi with its gradient [ns]
  std::int64_t bytes = 0;                  // what the evaluator keeps, its nodes apart
  // What the shape's certificate says, where it has one, else -1: mean error within 0.05 d of the surface [d], 95 % of
  // angles [degrees], both against the triangles that the network was learned from.
  double certificate_phi = -1, certificate_normal = -1;

  std::vector<double> phi_seconds, gradient_seconds;  // a round each
};
// Errors of body 0's phi; adds one round of time to the row.
void measure_queries(Simulation& simulation, QueryPoints const& band, QueryPoints const& surface, QueryRow& row);

// Forces of pairs at given poses.
struct PairForces {
  std::vector<Vec3> force;  // elastic, on the first of each pair [N]
  double rounding = 0;      // sum of |phi - phi in double| A over sum of phi A, over the nodes that carry force
};
PairForces measure_forces(Simulation& simulation, std::vector<PairPose> const& pairs);
// Root mean square over pairs of |force - reference| / |reference|.
double force_error(std::vector<Vec3> const& force, std::vector<Vec3> const& reference);

// Pairs that collide and part again, without friction or damping.
struct CollisionRow {
  std::string subject;
  int nodes = 0;
  double step = 0;        // in automatic ones
  double seconds = 0;     // the step [s]
  int steps = 0;          // of the whole collision
  double energy = 0;      // root mean square over pairs of the relative change of their energy
  double trajectory = 0;  // ... over grains of the way between their ends here and with the smallest step [d]
  std::vector<Vec3> end;  // positions [m]; empty: a watch stopped the run
};
// One row for each of `steps`, see CostOptions; the last is what trajectories are compared with.
std::vector<CollisionRow> measure_collisions(Simulation& simulation, std::vector<PairPose> const& pairs,
                                             std::vector<double> const& steps, double speed);

// An evaluator with a node count: what it costs, how far its forces are off.
struct CostRow {
  std::string subject;
  int nodes = 0;
  double node_error = 0;   // of forces, against the same phi with the most nodes
  double shape_error = 0;  // of forces with the most nodes, against the formula's; the formula: 0
  double error = 0;        // of forces, against the formula with the most nodes: both together
  double rounding = 0;     // see PairForces
  double step = 0;         // automatic one of the heap [s]
  // Processor time of the one thread: what others do on the machine is not counted.
  double rest_us = 0, flow_us = 0;            // a particle and step [us]
  double rest_queries = 0, flow_queries = 0;  // a step
  double rest_share = 0, flow_share = 0;      // ... over the nodes of contacting pairs
  double nodes_bytes = 0;                     // of one template
  double grain_bytes = 0;                     // of a grain: state, pairs, lists, history
};

// A heap under way, from a frame in which it is at rest.
class HeapMeter {
 public:
  std::unique_ptr<Simulation> simulation;
  StepMeter meter;
  SteppedScene rest, flow;

  HeapMeter(std::unique_ptr<Simulation> made, CostOptions const& options);
  void measure(int steps);
  double particle_step_us(SteppedScene const& scene, int steps) const;  // median processor time [us]
  // Fills in what the rounds told.
  void tell(CostOptions const& options, CostRow& row) const;
};

// The heap of the last subject under another skin of its node lists: less or more steps of motion before a rebuild.
struct SkinRow {
  double steps = 0;
  double rest_us = 0, flow_us = 0;            // a particle-step [us]
  double rest_queries = 0, flow_queries = 0;  // a step
  double rest_rebuilt = 0, flow_rebuilt = 0;  // lists made anew, a step
};
std::vector<SkinRow> measure_skins(CostOptions const& options, int nodes, Frame const& frame);

// What an effect adds to the step: the heap of the last subject with it.
struct EffectRow {
  std::string effect;  // in the words of the case file; the first: none
  double rest_us = 0, flow_us = 0;
};
std::vector<EffectRow> measure_effects(CostOptions const& options, int nodes, Frame const& frame);

}  // namespace scree
