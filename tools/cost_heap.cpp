// cost_heap.cpp: the heap of `scree cost`, see cost_meters.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/cost_meters.h"

namespace scree {

HeapMeter::HeapMeter(std::unique_ptr<Simulation> made, CostOptions const& options)
    : simulation(std::move(made)), meter(*simulation) {
  Simulation::Impl const& s = simulation->impl();
  State const state = s.state;
  Workspace const work = s.work;
  rest = meter.warm("rest", state, work, options.warm_up);
  flow = meter.warm("flowing", flowing(state, 0.5 * options.speed), work, options.warm_up);
}

void HeapMeter::measure(int steps) {
  meter.measure(rest, steps);
  meter.measure(flow, steps);
}

double HeapMeter::particle_step_us(SteppedScene const& scene, int steps) const {
  return 1e6 * median(scene.cpu) / steps / simulation->bodies();
}

void HeapMeter::tell(CostOptions const& options, CostRow& row) const {
  auto const steps = static_cast<double>(options.round_steps);
  Scene const& scene = simulation->impl().scene;
  row.step = simulation->time_step();
  auto const fill = [&](SteppedScene const& s, double& us, double& queries, double& share) {
    us = particle_step_us(s, options.round_steps);
    queries = static_cast<double>(s.counts.queries()) / steps;
    auto const touching = static_cast<double>(nodes_of_contacting_pairs(scene, s.work));
    share = touching > 0 ? queries / touching : 0;
  };
  fill(rest, row.rest_us, row.rest_queries, row.rest_share);
  fill(flow, row.flow_us, row.flow_queries, row.flow_share);
  row.nodes_bytes = row.grain_bytes = 0;
  for (Plan::Array const& a : simulation->plan().arrays) {
    bool const grain = a.name == "state" || a.name == "boxes" || a.name == "pairs" || a.name == "node lists" ||
                       a.name == "contact history";
    if (a.name == "surface nodes") row.nodes_bytes = static_cast<double>(a.bytes);
    if (grain) row.grain_bytes += static_cast<double>(a.bytes) / scene.bodies();
  }
}

std::vector<SkinRow> measure_skins(CostOptions const& options, int nodes, Frame const& frame) {
  std::vector<HeapMeter> heap;
  std::vector<SkinRow> rows;
  for (double factor : {1. / 32, 1. / 16, 1. / 8, 1. / 4, 1. / 2, 1., 2., 4.}) {
    SimulationOptions simulation;
    rows.emplace_back().steps = factor * steps_a_skin;
    simulation.skin_steps = rows.back().steps;
    Case const c = cost_case(options, cost_subjects(options).back(), nodes);
    heap.emplace_back(std::make_unique<Simulation>(c, simulation, frame), options);
  }
  for (int round = 0; round < options.rounds; ++round)
    for (HeapMeter& h : heap) h.measure(options.round_steps);
  for (std::size_t i = 0; i < heap.size(); ++i) {
    auto const fill = [&](SteppedScene const& s, double& us, double& queries, double& rebuilt) {
      us = heap[i].particle_step_us(s, options.round_steps);
      queries = static_cast<double>(s.counts.queries()) / options.round_steps;
      rebuilt = static_cast<double>(s.counts.rebuilt) / options.round_steps;
    };
    fill(heap[i].rest, rows[i].rest_us, rows[i].rest_queries, rows[i].rest_rebuilt);
    fill(heap[i].flow, rows[i].flow_us, rows[i].flow_queries, rows[i].flow_rebuilt);
  }
  return rows;
}

}  // namespace scree
