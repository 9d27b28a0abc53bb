// step_meter.cpp: see step_meter.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/step_meter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <random>

namespace scree {
namespace {

StepCounts counts_of(Simulation::Impl const& s) {
  NodeLists const& lists = s.work.gather.lists;
  return {lists.rebuilt, lists.block_queries, s.work.active.queries, 0, s.work.active.fresh};
}

}  // namespace

double process_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

StepMeter::StepMeter(Simulation& simulation) : simulation_(simulation) {
  simulation_.impl().c.time.end = 1e9;
  simulation_.impl().effects.settle = false;
}

Simulation::Impl& StepMeter::restore(State const& state, Workspace const& work, int threads) {
  Simulation::Impl& s = simulation_.impl();
  s.state = state;
  s.work = work;
  s.run_state = RunState::running;
  s.queue.threads = threads;
  return s;
}

SteppedScene StepMeter::warm(std::string const& name, State const& from, Workspace const& work, int steps) {
  Simulation::Impl const& s = restore(from, work, 1);
  for (int k = 0; k < steps; ++k) simulation_.step();
  SteppedScene scene;
  scene.name = name;
  scene.state = s.state;
  scene.work = s.work;
  return scene;
}

void StepMeter::measure(SteppedScene& scene, int steps) {
  Simulation::Impl& s = restore(scene.state, scene.work, scene.threads);
  s.profile.clear();
  StepCounts const before = counts_of(s);
  std::int64_t active = 0;
  double const cpu = process_seconds();
  auto const begin = std::chrono::steady_clock::now();
  for (int k = 0; k < steps; ++k) {
    simulation_.step();
    active += s.work.active.first.empty() ? 0 : s.work.active.first.back();
  }
  scene.wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  scene.cpu.push_back(process_seconds() - cpu);
  StepCounts const after = counts_of(s);
  scene.counts = {after.rebuilt - before.rebuilt, after.block - before.block, after.listed - before.listed, active,
                  after.again - before.again};
  scene.stages.clear();
  for (auto const& e : s.profile.entries()) scene.stages[e.name] = e.seconds;
}

State flowing(State state, double speed) {
  std::mt19937_64 random(1);
  for (Vec3& v : state.velocity)  // by hand: distributions differ between standard libraries
    for (int k = 0; k < 3; ++k) v[k] = speed * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
  return state;
}

std::int64_t nodes_of_contacting_pairs(Scene const& scene, Workspace const& work) {
  std::int64_t nodes = 0;
  auto const of = [&](int body) { return scene.shape[scene.shape_of[body]].nodes; };
  for (std::size_t k = 0; k < work.pair.size(); ++k) {
    if (work.closed_form[k] || work.result[k].active == 0) continue;
    nodes += of(work.pair[k].a);
    if (!work.pair[k].with_plane()) nodes += of(work.pair[k].b);
  }
  return nodes;
}

Case heap_case(std::vector<LibraryCase> const& library, std::vector<std::string> const& shapes, int grains, int nodes,
               double fall) {
  Case c;
  c.name = "heap";
  c.gravity = Vec3{0, 0, -9.81};
  c.library = library;
  c.material = {{"rock", 2650}};
  ContactCase contact;
  contact.pair = {"rock", "rock"};
  contact.friction = 0.5;
  contact.damping_ratio = 0.7;
  c.contact = {contact};
  double const d = 0.1, side = d * std::max(2.5, 1.4 * std::cbrt(grains));
  GrainsCase g;
  g.name = "grain";
  g.material = "rock";
  g.shapes = shapes;
  g.nodes = nodes;
  g.count = grains;
  g.diameter = d;
  g.insert.box = {{0, 0, 0}, {side, side, 1000 * side}};
  c.grains = {g};
  WallCase w;
  w.name = "container";
  w.material = "rock";
  w.kind = WallKind::box;
  w.max = {side, side, 1001 * side};
  w.open = {"+z"};
  c.wall = {w};
  c.time.end = fall;
  c.time.settle = SettleCase{5, 0.4 * fall, 1e-8, 0.02};
  c.limits.overlap = 0.5;
  return c;
}

}  // namespace scree
