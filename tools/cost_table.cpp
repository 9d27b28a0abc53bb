// cost_table.cpp: see cost_table.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/cost_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

std::vector<char> pareto_front(std::vector<std::pair<double, double>> const& offers) {
  std::vector<char> front(offers.size(), 1);
  for (std::size_t i = 0; i < offers.size(); ++i)
    for (std::size_t k = 0; k < offers.size(); ++k) {
      bool const no_worse = offers[k].first <= offers[i].first && offers[k].second <= offers[i].second;
      if (no_worse && (offers[k] != offers[i] || k < i)) front[i] = 0;
    }
  return front;
}

std::string query_csv(std::vector<QueryRow> const& rows) {
  std::string text =
      "evaluator,phi_mean_d,phi_largest_d,normal_mean_deg,normal_p95_deg,phi_ns,gradient_ns,evaluator_bytes,"
      "certificate_phi_d,certificate_normal_p95_deg\n";
  auto const or_empty = [](double v) { return v < 0 ? std::string() : fmt::format("{:.4g}", v); };
  for (QueryRow const& r : rows)
    text += fmt::format("{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{},{},{}\n", r.subject, r.phi_mean, r.phi_largest,
                        r.normal_mean, r.normal_p95, r.phi_ns, r.gradient_ns, r.bytes, or_empty(r.certificate_phi),
                        or_empty(r.certificate_normal));
  return text;
}

std::string collision_csv(std::vector<CollisionRow> const& rows) {
  std::string text = "evaluator,nodes,step_auto,step_s,steps,energy_drift,trajectory_d\n";
  for (CollisionRow const& r : rows)
    text += fmt::format("{},{},{:g},{:.4g},{},{}\n", r.subject, r.nodes, r.step, r.seconds, r.steps,
                        r.end.empty() ? "stopped,stopped" : fmt::format("{:.4g},{:.4g}", r.energy, r.trajectory));
  return text;
}

std::string cost_csv(std::vector<CostRow> const& rows) {
  std::string text =
      "evaluator,nodes,force_error,node_error,shape_error,rounding,step_s,rest_us,flow_us,rest_queries,flow_queries,"
      "rest_share,flow_share,template_bytes,grain_bytes\n";
  for (CostRow const& r : rows)
    text += fmt::format(
        "{},{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.5g},{:.5g},{:.4g},{:.4g},{:.0f},{:.0f}\n", r.subject,
        r.nodes, r.error, r.node_error, r.shape_error, r.rounding, r.step, r.rest_us, r.flow_us, r.rest_queries,
        r.flow_queries, r.rest_share, r.flow_share, r.nodes_bytes, r.grain_bytes);
  return text;
}

std::string price_list(std::vector<CostRow> const& rows, std::vector<QueryRow> const& queries) {
  std::vector<std::pair<double, double>> offers;
  for (CostRow const& r : rows) offers.push_back({r.rest_us, r.error});
  std::vector<char> const front = pareto_front(offers);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (front[i] || rows[i].subject == rows.back().subject) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rows[a].error > rows[b].error; });
  std::string text =
      "| force error | of nodes | of shape | evaluator | nodes | us a particle-step at rest | flowing | s a grain and "
      "simulated s | normals [deg] | ns a query | kB a shape |\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (std::size_t const i : order) {
    CostRow const& r = rows[i];
    auto const q = std::find_if(queries.begin(), queries.end(), [&](auto const& x) { return x.subject == r.subject; });
    text += fmt::format(
        "| {:.2g} % | {:.2g} % | {:.2g} % | {}{} | {} | {:.1f} | {:.1f} | {:.2f} | {:.2g} | {:.0f} | {:.0f} |\n",
        100 * r.error, 100 * r.node_error, 100 * r.shape_error, r.subject, front[i] ? " *" : "", r.nodes, r.rest_us,
        r.flow_us, 1e-6 * r.rest_us / r.step, q->normal_mean, q->phi_ns,
        1e-3 * (r.nodes_bytes + static_cast<double>(q->bytes)));
  }
  return text + "\n\\* no other evaluator and node count has a cheaper step and smaller errors\n";
}

std::string effect_csv(std::vector<EffectRow> const& rows) {
  std::string text = "effects,rest_us,flow_us,rest_ratio,flow_ratio\n";
  for (EffectRow const& r : rows)
    text += fmt::format("{},{:.4g},{:.4g},{:.3f},{:.3f}\n", r.effect, r.rest_us, r.flow_us,
                        r.rest_us / rows.front().rest_us, r.flow_us / rows.front().flow_us);
  return text;
}

std::string skin_csv(std::vector<SkinRow> const& rows) {
  std::string text = "skin_steps,rest_us,flow_us,rest_queries,flow_queries,rest_rebuilt,flow_rebuilt\n";
  for (SkinRow const& r : rows)
    text += fmt::format("{:g},{:.4g},{:.4g},{:.5g},{:.5g},{:.4g},{:.4g}\n", r.steps, r.rest_us, r.flow_us,
                        r.rest_queries, r.flow_queries, r.rest_rebuilt, r.flow_rebuilt);
  return text;
}

}  // namespace scree
