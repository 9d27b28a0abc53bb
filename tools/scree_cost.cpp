// scree_cost.cpp: `scree cost`: what accuracy costs in time, evaluator by evaluator and node count by node count.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "core/results.h"
#include "kernels/base/build_info.h"
#include "shapes/whole_file.h"
#include "tools/cost_table.h"
#include "tools/machine_costs.h"
#include "tools/measured_on.h"
#include "tools/plot_script.h"
#include "tools/promise.h"
#include "tools/scree_commands.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

fs::path find_library(CostArguments const& a) {
  char const* const folder = std::getenv("SCREE_LIBRARY");
  std::vector<fs::path> const places = {a.library, fs::path("shapes") / "library" / "grains.h5",
                                        fs::path(folder ? folder : "") / "grains.h5", a.share / "grains.h5"};
  if (!a.library.empty() && !fs::exists(a.library)) throw InputError({a.library.string() + ": there is no such file"});
  for (fs::path const& place : places)
    if (!place.empty() && fs::exists(place)) return place;
  throw InputError({"the shipped library grains.h5 was not found: give it with --library"});
}

CostOptions options_of(CostArguments const& a) {
  CostOptions o;
  o.library = find_library(a);
  for (fs::path const& file : a.nets) o.nets.push_back(fs::absolute(file));
  if (a.large) o.nodes.push_back(64000), o.reference_nodes = 256000;
  if (a.quick) {
    o.nodes = {250};
    o.reference_nodes = 500;
    o.few = true;
    o.steps = {1, 0.25};
    o.queries = 500, o.grains = 4, o.fall = 0.02, o.warm_up = 2, o.round_steps = 5, o.rounds = 1;
  }
  if (!a.nodes.empty()) o.nodes = a.nodes;
  std::sort(o.nodes.begin(), o.nodes.end());
  o.nodes.erase(std::unique(o.nodes.begin(), o.nodes.end()), o.nodes.end());
  std::vector<std::string> names;
  for (CostSubject const& subject : cost_subjects(o)) names.push_back(subject.name);
  std::sort(names.begin(), names.end());
  if (auto const twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
    throw InputError({*twice + ": two of this name; --net takes the names of its files"});
  return o;
}

void progress(std::string const& what) {
  fmt::print("{}\n", what);
  std::fflush(stdout);
}

// The heap at rest that all subjects start from: of an earlier run into the same folder, or settled here.
Frame heap_at_rest(CostOptions const& o, fs::path const& folder) {
  fs::path const file = folder / "heap.h5";
  Case const c = cost_case(o, cost_subjects(o).front(), 1000);
  if (fs::exists(file)) {
    ResultsReader const reader(file);
    if (reader.header().case_text == to_toml(c)) return reader.frame(-1);
  }
  progress(fmt::format("settling {} grains", o.grains));
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  ResultsWriter writer(file, s.results_header());
  writer.write_frame(s.frame());
  writer.finish({});
  return s.frame();
}

// Everything about one subject at one node count.
struct Offer {
  CostRow row;
  HeapMeter heap;
  std::vector<Vec3> force;  // of the pairs [N]
};

Offer make_offer(CostOptions const& o, CostSubject const& subject, int nodes, Frame const& frame) {
  progress(fmt::format("{}, {} nodes", subject.name, nodes));
  CostRow row;
  row.subject = subject.name;
  row.nodes = nodes;
  auto simulation = std::make_unique<Simulation>(cost_case(o, subject, nodes), SimulationOptions{}, frame);
  if (simulation->impl().scene.library.shape.size() != 1)
    throw InputError({subject.library.string() + ": more than one shape; give a file with a network of " + cost_truth});
  return {row, HeapMeter(std::move(simulation), o), {}};
}

// Times. Rounds of all are interleaved: a neighbour on the machine hits all alike.
std::vector<QueryRow> measure_times(CostOptions const& o, std::vector<Offer>& offers) {
  std::vector<QueryRow> queries;
  for (Offer const& offer : offers)
    if (offer.row.nodes == o.nodes.front()) queries.emplace_back().subject = offer.row.subject;
  QueryPoints const band = truth_points(o.queries, contact_band), surface = truth_points(o.queries, 0);
  for (int round = 0; round < o.rounds; ++round) {
    progress(fmt::format("round {} of {}", round + 1, o.rounds));
    for (Offer& offer : offers) offer.heap.measure(o.round_steps);
    for (std::size_t i = 0; i < queries.size(); ++i)
      measure_queries(*offers[i * o.nodes.size()].heap.simulation, band, surface, queries[i]);
  }
  for (Offer& offer : offers) offer.heap.tell(o, offer.row);
  return queries;
}

// Errors of the pairs' forces against those of the same phi with the most nodes, and of the formula.
void compare_forces(CostOptions const& o, Frame const& frame, std::vector<PairPose> const& pairs,
                    std::vector<Offer>& offers) {
  std::vector<Vec3> truth;
  for (CostSubject const& subject : cost_subjects(o)) {
    progress(fmt::format("reference: {}, {} nodes", subject.name, o.reference_nodes));
    Simulation s(cost_case(o, subject, o.reference_nodes), {}, frame);
    std::vector<Vec3> const reference = measure_forces(s, pairs).force;
    if (truth.empty()) truth = reference;  // the formula is the first subject
    for (Offer& offer : offers) {
      if (offer.row.subject != subject.name) continue;
      offer.row.node_error = force_error(offer.force, reference);
      offer.row.shape_error = force_error(reference, truth);
      offer.row.error = force_error(offer.force, truth);
    }
  }
}

std::string measured_on() {
  BuildInfo const& b = build_info();
  return fmt::format("{}, one thread; {} {}, scree {} {}; {}\n", cpu_name(), b.compiler, b.build_type, b.version,
                     b.commit, utc_date());
}

}  // namespace

int cost_command(CostArguments const& a) {
  CostOptions const o = options_of(a);
  fs::create_directories(a.output);
  Frame const frame = heap_at_rest(o, a.output);
  std::vector<Offer> offers;
  for (CostSubject const& subject : cost_subjects(o))
    for (int nodes : o.nodes) offers.push_back(make_offer(o, subject, nodes, frame));
  std::vector<QueryRow> const queries = measure_times(o, offers);
  // From here on the scenes have neither weight nor friction.
  std::vector<PairPose> const pairs = draw_pairs(o.grains / 2, o.overlap);
  std::vector<CollisionRow> collisions;
  for (Offer& offer : offers) {
    progress(fmt::format("collisions: {}, {} nodes", offer.row.subject, offer.row.nodes));
    PairForces const forces = measure_forces(*offer.heap.simulation, pairs);
    offer.force = forces.force;
    offer.row.rounding = forces.rounding;
    for (CollisionRow& row : measure_collisions(*offer.heap.simulation, pairs, o.steps, o.speed)) {
      row.subject = offer.row.subject, row.nodes = offer.row.nodes;
      collisions.push_back(std::move(row));
    }
  }
  compare_forces(o, frame, pairs, offers);

  int const usual = o.nodes[std::min<std::size_t>(1, o.nodes.size() - 1)];
  progress("effects");
  std::vector<EffectRow> const effects = measure_effects(o, usual, frame);
  progress("skins");
  std::vector<SkinRow> const skins = measure_skins(o, usual, frame);

  std::vector<CostRow> rows;
  for (Offer const& offer : offers) rows.push_back(offer.row);
  std::string const list = price_list(rows, queries) + "\n" + measured_on();
  replace_whole_file(a.output / "cost.csv", cost_csv(rows));
  replace_whole_file(a.output / "queries.csv", query_csv(queries));
  replace_whole_file(a.output / "collisions.csv", collision_csv(collisions));
  replace_whole_file(a.output / "effects.csv", effect_csv(effects));
  replace_whole_file(a.output / "skins.csv", skin_csv(skins));
  replace_whole_file(a.output / "cost.md", list);
  fmt::print("\n{}\n{}: cost.md, cost.csv, queries.csv, collisions.csv, effects.csv, skins.csv\n", list,
             a.output.string());
  std::string const trouble = run_plot_script(plot_cost_text, {a.output.string()});
  if (trouble.empty())
    fmt::print("picture: {}, .svg\n", (a.output / "cost.png").string());
  else
    fmt::print("no picture: {}\n", trouble);
  return exit_ok;
}

int promise_command(CostArguments const& a) {
  fs::create_directories(a.output);
  PromiseOptions o;
  o.library = find_library(a);
  o.accuracy.threads = a.threads;
  if (a.quick) o.accuracy.dense_points = 32000, o.accuracy.most_nodes = 4000, o.contacts = 4;
  o.costs = machine_costs();
  std::vector<PromiseResult> results;
  int taken = 0, kept = 0, contacts = 0, within = 0;
  double worst = 0;  // 95 % of the contacts of a setting, in budgets
  for (int index = a.from; taken < a.promise; ++index) {
    PromiseResult const r = try_promise(promise_setting(a.seed, index, true), o, 100000 + index);
    results.push_back(r);
    PromiseSetting const& s = r.setting;
    std::string const what =
        fmt::format("{}, {:.2g} % d deep, budget {:.2g} %", s.shape, 100 * s.overlap, 100 * s.budget);
    replace_whole_file(a.output / "promise.csv", promise_csv(results));
    if (!r.refused.empty()) {
      progress(what + ": " + r.refused);
      continue;
    }
    ++taken, kept += r.kept(), contacts += o.contacts, within += r.within;
    worst = std::max(worst, r.p95 / s.budget);
    progress(fmt::format("{}: {} nodes, 95 % of contacts within {:.2g} %{}", what, r.nodes, 100 * r.p95,
                         r.kept() ? "" : ": not kept"));
  }
  fmt::print(
      "{} of {} settings kept their budget in 95 % of {} contacts each, {} were refused; worst {:.2f} budgets; "
      "{:.2f} % of all contacts\n{}{}: promise.csv\n",
      kept, taken, o.contacts, results.size() - static_cast<std::size_t>(taken), worst, 100.0 * within / contacts,
      measured_on(), a.output.string());
  return kept >= 0.95 * taken ? exit_ok : exit_watch;
}

}  // namespace scree
