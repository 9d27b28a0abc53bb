// cost_scene.cpp: see cost_scene.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/cost_scene.h"

#include <algorithm>

#include "shapes/analytic_shapes.h"
#include "shapes/random.h"
#include "shapes/support_points.h"
#include "tools/step_meter.h"

namespace scree {

char const cost_truth[] = "ellipsoid:1.5:1.25:1";

std::vector<CostSubject> cost_subjects(CostOptions const& options) {
  auto const grid = [](int cells) {
    return CostSubject{"grid " + std::to_string(cells), cost_truth, Evaluator::grid, cells, {}};
  };
  std::vector<CostSubject> all = {{"formula", cost_truth, Evaluator::analytic, 0, {}}, grid(22)};
  if (!options.few) all.insert(all.end(), {grid(43), grid(86), {"mesh 16", cost_truth, Evaluator::mesh, 16, {}}});
  for (std::filesystem::path const& file : options.nets)
    all.push_back({"net " + file.stem().string(), "grains:*", Evaluator::net, 0, file});
  all.push_back({"net 6x64", "grains:ellipsoid/2", Evaluator::net, 0, options.library});
  return all;
}

Case cost_case(CostOptions const& options, CostSubject const& subject, int nodes) {
  std::vector<LibraryCase> library;
  if (!subject.library.empty()) library = {{"grains", subject.library}};
  Case c = heap_case(library, {subject.shape}, options.grains, nodes, options.fall);
  GrainsCase& g = c.grains[0];
  g.evaluator = subject.evaluator;
  if (subject.evaluator == Evaluator::grid) g.grid_cells = subject.cells;
  if (subject.evaluator == Evaluator::mesh) g.mesh_cells = subject.cells;
  return c;
}

std::vector<PairPose> draw_pairs(int count, double overlap) {
  Library library;
  library.shape = {builtin_shape(cost_truth)};
  Shape const& body = library.shape[0];
  PhiBatch const phi = reference_phi(library, body);
  Vec3 const axes = body.analytic.half_size;
  std::vector<Vec3> surface = quasi_uniform_directions(500);
  for (Vec3& p : surface) p = multiply(p, axes);
  Random random(7);
  auto const turn = [&] {
    return normalized(Quat{random.normal(), random.normal(), random.normal(), random.normal()});
  };
  std::vector<PairPose> pairs;
  std::vector<Vec3> point(surface.size());
  std::vector<double> depth(surface.size());
  for (int k = 0; k < count; ++k) {
    PairPose p{turn(), turn(), random.direction()};
    Mat3 const a = to_matrix(p.a), b = to_matrix(p.b);
    double low = 0.5, high = 2 * body.bounding_radius;  // too deep, apart
    while (high - low > 1e-6) {
      double const middle = 0.5 * (low + high);
      for (std::size_t i = 0; i < point.size(); ++i)
        point[i] = transposed_times(a, p.direction * middle + b * surface[i]);
      phi(point, depth, {});
      (*std::max_element(depth.begin(), depth.end()) > overlap ? low : high) = middle;
    }
    p.distance = high;
    pairs.push_back(p);
  }
  return pairs;
}

void set_up_pairs(Simulation& simulation, std::vector<PairPose> const& pairs, double gap, double speed) {
  Simulation::Impl& s = simulation.impl();
  s.c.gravity.reset();
  s.effects.gravity = s.effects.settle = false;
  for (ContactParameters& contact : s.scene.contact) contact.friction = contact.damping_nodes = 0;
  s.state.node_history = {};
  s.state.time = 0;
  s.work = {};
  s.work.external.assign(s.scene.bodies(), {});
  s.run_state = RunState::running;
  // Above the heap, half-way between the walls.
  double const d = s.scene.diameter[0], side = s.c.wall[0].max.x;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Vec3 const at{0.5 * side, 0.5 * side, side + 4 * d * (1 + static_cast<double>(k))};
    Vec3 const half = pairs[k].direction * (0.5 * d * (pairs[k].distance + gap));
    for (int body : {0, 1}) {
      std::size_t const i = 2 * k + body;
      double const sign = body == 0 ? -1 : 1;
      s.state.position[i] = at + half * sign;
      s.state.orientation[i] = body == 0 ? pairs[k].a : pairs[k].b;
      s.state.velocity[i] = pairs[k].direction * (-0.5 * sign * speed);
      s.state.angular_momentum[i] = {};
    }
  }
  std::vector<Vec3> const still(s.scene.bodies());
  StepEstimate const estimate =
      estimate_critical_step(s.c, s.scene, {s.state.position, s.state.velocity, still, s.state.orientation});
  s.state.time_step = std::min(s.c.time.safety * estimate.critical, estimate.accurate);
  evaluate_contacts(s.queue, s.scene, s.effects, s.contacts, 0, s.state, s.work);
  s.report = watch(s.queue, s.scene, s.state, s.gravity_size(), s.work);
}

}  // namespace scree
