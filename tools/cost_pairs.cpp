// cost_pairs.cpp: pairs of grains of `scree cost`: forces and collisions, see cost_meters.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "tools/cost_meters.h"

namespace scree {
namespace {

// What rounding in the network, or in the values of a grid, does to phi where it carries force.
double rounding_of(Simulation::Impl const& s) {
  Shape const& shape = s.scene.library.shape[0];
  double difference = 0, whole = 0;
  ActiveNodes const& active = s.work.active;
  ShapeRecord const& record = s.scene.shape[0];
  for (std::size_t i = 0; i < active.node.size(); ++i) {
    double const exact = evaluate_reference(s.scene.library, shape, active.sample.point[i]);
    double const area = s.scene.node_area[record.first_node + active.node[i]];
    difference += std::abs(active.sample.phi[i] - exact) * area;
    whole += exact * area;
  }
  return whole > 0 ? difference / whole : 0;
}

double pair_energy(Simulation::Impl& s, int pair) {
  SceneView const scene = s.scene.view();
  StateView const state = s.state.view();
  double energy = kinetic_energy(scene, state, 2 * pair) + kinetic_energy(scene, state, 2 * pair + 1);
  for (std::size_t k = 0; k < s.work.pair.size(); ++k)
    if (s.work.pair[k].a == 2 * pair || s.work.pair[k].b == 2 * pair) energy += s.work.result[k].energy_normal;
  return energy;
}

double root_mean_square(std::vector<double> const& values) {
  double sum = 0;
  for (double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// `seconds`: of the whole; the step nearest to `step` that divides it.
CollisionRow collide(Simulation& simulation, std::vector<PairPose> const& pairs, double step, double seconds,
                     double speed) {
  Simulation::Impl& s = simulation.impl();
  set_up_pairs(simulation, pairs, 0.012, speed);
  CollisionRow row;
  row.step = step;
  row.steps = static_cast<int>(std::ceil(seconds / (step * s.state.time_step)));
  row.seconds = seconds / row.steps;
  s.c.time.step = s.state.time_step = row.seconds;
  s.c.time.end = 2 * seconds;
  std::vector<double> change;
  for (std::size_t k = 0; k < pairs.size(); ++k) change.push_back(-pair_energy(s, static_cast<int>(k)));
  double const whole = -change[0];  // equal grains at equal speeds
  try {
    for (int k = 0; k < row.steps; ++k) simulation.step();
  } catch (WatchStop const&) {  // the step is too large
    return row;
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    change[k] = (change[k] + pair_energy(s, static_cast<int>(k))) / whole;
    row.end.push_back(s.state.position[2 * k]);
    row.end.push_back(s.state.position[2 * k + 1]);
  }
  row.energy = root_mean_square(change);
  return row;
}

}  // namespace

PairForces measure_forces(Simulation& simulation, std::vector<PairPose> const& pairs) {
  set_up_pairs(simulation, pairs, 0, 0);
  Simulation::Impl const& s = simulation.impl();
  PairForces out;
  for (std::size_t k = 0; k < pairs.size(); ++k) out.force.push_back(s.state.wrench.elastic[2 * k].force);
  out.rounding = rounding_of(s);
  return out;
}

double force_error(std::vector<Vec3> const& force, std::vector<Vec3> const& reference) {
  std::vector<double> error;
  for (std::size_t k = 0; k < force.size(); ++k) error.push_back(norm(force[k] - reference[k]) / norm(reference[k]));
  return root_mean_square(error);
}

std::vector<CollisionRow> measure_collisions(Simulation& simulation, std::vector<PairPose> const& pairs,
                                             std::vector<double> const& steps, double speed) {
  // A contact of 1 % d at 1 m/s lasts 3 ms; slower ones of the same law last longer, as speed^(-1/3).
  double const seconds = 5e-3 / std::cbrt(speed);
  std::vector<CollisionRow> rows;
  double const d = simulation.impl().scene.diameter[0];
  for (double step : steps) rows.push_back(collide(simulation, pairs, step, seconds, speed));
  std::vector<Vec3> const& best = rows.back().end;
  for (CollisionRow& row : rows) {
    std::vector<double> way;
    for (std::size_t i = 0; i < std::min(row.end.size(), best.size()); ++i)
      way.push_back(norm(row.end[i] - best[i]) / d);
    row.trajectory = way.empty() ? 0 : root_mean_square(way);
  }
  return rows;
}

}  // namespace scree
