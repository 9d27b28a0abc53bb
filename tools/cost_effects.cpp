// cost_effects.cpp: what effects add to a step, see cost_meters.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/cost_meters.h"

namespace scree {
namespace {

struct CostEffect {
  char const* name;
  void (*add)(Case& c);
};

void friction(Case& c) { c.contact[0].friction = 0.5; }
void damping(Case& c) { c.contact[0].damping_ratio = 0.7; }
void rolling(Case& c) { c.contact[0].rolling = RollingCase{0.1}; }
void cohesion(Case& c) { c.contact[0].cohesion = CohesionCase{1e3, 5e-4}; }
void drag(Case& c) { c.drag = DragCase{1.2, 0.5, {}}; }
void global_damping(Case& c) { c.damping = DampingCase{1}; }

CostEffect constexpr effects[] = {
    {"none", [](Case&) {}},
    {"friction", friction},
    {"contact damping", damping},
    {"friction + rolling", [](Case& c) { friction(c), rolling(c); }},
    {"cohesion", cohesion},
    {"drag", drag},
    {"damping", global_damping},
    {"all", [](Case& c) { friction(c), damping(c), rolling(c), cohesion(c), drag(c), global_damping(c); }},
};

}  // namespace

std::vector<EffectRow> measure_effects(CostOptions const& options, int nodes, Frame const& frame) {
  std::vector<HeapMeter> heap;
  std::vector<EffectRow> rows;
  for (CostEffect const& effect : effects) {
    Case c = cost_case(options, cost_subjects(options).back(), nodes);
    c.contact[0].friction.reset();
    c.contact[0].damping_ratio.reset();
    effect.add(c);
    heap.emplace_back(std::make_unique<Simulation>(c, SimulationOptions{}, frame), options);
    rows.emplace_back().effect = effect.name;
  }
  for (int round = 0; round < options.rounds; ++round)
    for (HeapMeter& h : heap) h.measure(options.round_steps);
  for (std::size_t i = 0; i < heap.size(); ++i) {
    rows[i].rest_us = heap[i].particle_step_us(heap[i].rest, options.round_steps);
    rows[i].flow_us = heap[i].particle_step_us(heap[i].flow, options.round_steps);
  }
  return rows;
}

}  // namespace scree
