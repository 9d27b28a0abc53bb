// machine_costs.cpp: see machine_costs.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/machine_costs.h"

#include "core/figure_cache.h"
#include "kernels/base/build_info.h"
#include "kernels/sdf/sdf_batch.h"
#include "shapes/analytic_shapes.h"
#include "shapes/content_cache.h"
#include "tools/cost_meters.h"
#include "tools/measured_on.h"

namespace scree {
namespace {

StepCosts measure(std::vector<int> const& nodes, int grains) {
  CostOptions o;
  o.grains = grains, o.fall = 0.3, o.warm_up = 20, o.round_steps = 50, o.rounds = 3;
  CostSubject const formula = cost_subjects(o).front();
  Simulation settling(cost_case(o, formula, nodes.front()), {});
  while (settling.step() == RunState::running) {
  }
  Frame const rest = settling.frame();
  StepCosts out;
  for (int const n : nodes) {
    HeapMeter heap(std::make_unique<Simulation>(cost_case(o, formula, n), SimulationOptions{}, rest), o);
    for (int round = 0; round < o.rounds; ++round) heap.measure(o.round_steps);
    CostRow row;
    heap.tell(o, row);
    out.nodes.push_back(n);
    out.us.push_back(0.5 * (row.rest_us + row.flow_us));
    out.queries.push_back(0.5 * (row.rest_queries + row.flow_queries) / grains);
  }
  Library library;
  library.shape = {builtin_shape(cost_truth)};
  out.query_ns = measure_query_ns(library, library.shape[0]);
  return out;
}

}  // namespace

StepCosts machine_costs(std::vector<int> const& nodes, int grains) {
  BuildInfo const& b = build_info();
  ContentHash hash;
  for (char const* word : {b.version, b.commit, b.compiler, b.build_type}) hash.add(std::string(word));
  std::string const machine = hash.add(std::string(sdf_isa())).add(cpu_name()).digits();
  std::string const key = ContentHash().add(std::string("step costs")).add(machine).add(nodes).add(grains).digits();
  StepCosts out;
  std::vector<double> const kept = read_figures(key);
  if (kept.size() == 2 * nodes.size() + 1) {
    auto const half = kept.begin() + static_cast<std::ptrdiff_t>(nodes.size());
    out = {machine, nodes, {kept.begin(), half}, {half, kept.end() - 1}, kept.back()};
    return out;
  }
  out = measure(nodes, grains);
  out.machine = machine;
  std::vector<double> figures = out.us;
  figures.insert(figures.end(), out.queries.begin(), out.queries.end());
  figures.push_back(out.query_ns);
  keep_figures(key, figures);
  return out;
}

}  // namespace scree
