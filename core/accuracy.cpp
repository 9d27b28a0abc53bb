// accuracy.cpp: see accuracy.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>

#include "core/contact_errors.h"
#include "core/figure_cache.h"
#include "core/impulse_error.h"
#include "core/time_step.h"
#include "shapes/content_cache.h"

namespace scree {
namespace {

int constexpr recipe = 1;         // counts changes of nodes and meters that alter errors
int constexpr least_nodes = 250;  // doubled up to what is enough
int constexpr shapes_an_entry = 8;
// Above 0.5 of the critical step the ledger suffers, core/simulation.cpp.
double constexpr safeties[] = {0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.05};
double constexpr fallback_overlap = 0.01;  // where nothing weighs or moves [d]
double constexpr least_overlap = 1e-3;     // the automatic step assumes no less [d]

// Node errors of one shape, from the cache or measured, and kept.
class KnownErrors {
 public:
  KnownErrors(Library const& library, Shape const& shape, PressureLaw const& law, double diameter, double overlap,
              int dense)
      : meter_(library, shape, law, diameter, overlap, dense) {
    ContentHash hash;
    hash.add(std::string("contact errors")).add(recipe).add(dense).add(overlap).add(law.kind);
    hash.add(law.onset / diameter).add(shape.bounding_radius).add(shape.lipschitz).add_phi(library, shape);
    key_ = hash.digits();
    std::vector<double> const kept = read_figures(key_);
    for (std::size_t i = 0; i + 1 < kept.size(); i += 2) error_[static_cast<int>(kept[i])] = kept[i + 1];
  }

  double at(int nodes) {
    auto const [place, fresh] = error_.try_emplace(nodes, 0);
    if (!fresh) return place->second;
    place->second = meter_.at(nodes);
    std::vector<double> all;
    for (auto const& [n, e] : error_) all.insert(all.end(), {static_cast<double>(n), e});
    keep_figures(key_, all);
    return place->second;
  }

  // The smallest count of the doubled ones with an error of at most `share`; 0: not even `most`.
  int enough(double share, int most) {
    int n = least_nodes;
    // Round bodies: about 0.4 nodes^-1.3 of those in the contact, 1 % d deep, which has a two-hundredth of all.
    while (2 * n <= most && 0.4 * std::pow(n / 200.0, -1.3) > share) n *= 2;
    while (at(n) > share) {
      n *= 2;
      if (n > most) return 0;
    }
    while (n > least_nodes && at(n / 2) <= share) n /= 2;
    return n;
  }

 private:
  ContactErrors meter_;
  std::string key_;
  std::map<int, double> error_;
};

// One shape of one entry.
struct Item {
  int entry, shape;
  KnownErrors errors;
  std::string trouble;
};

// Measured once a machine and shape.
double known_query_ns(Library const& library, Shape const& shape, StepCosts const& costs) {
  std::string const key =
      ContentHash().add(std::string("query")).add(recipe).add(costs.machine).add_phi(library, shape).digits();
  if (std::vector<double> const kept = read_figures(key); kept.size() == 1) return kept[0];
  double const ns = measure_query_ns(library, shape);
  keep_figures(key, {ns});
  return ns;
}

// Error of the force that phi's own error makes in contacts so deep: F ~ overlap^e, phi off by its certificate's mean.
double shape_error(Shape const& shape, double overlap, double exponent) {
  if (shape.kind == ShapeKind::analytic) return 0;
  if (shape.is_net() && shape.certificate.band_mae >= 0) return exponent * shape.certificate.band_mae / overlap;
  return -1;
}

class Picker {
 public:
  Picker(Case const& c, StepCosts const& costs, AccuracyOptions const& options)
      : c_(c), costs_(costs), options_(options), scene_(scene_without_nodes()) {}

  AccuracyPick pick();

 private:
  Scene scene_without_nodes();
  void describe(std::size_t entry);
  void choose_nodes(double share, std::vector<int>& nodes);
  void judge(double safety, std::vector<int> const& nodes);
  StepEstimate estimate_with(std::vector<int> const& nodes);
  double error_of_step(double safety) const;
  [[noreturn]] void refuse();

  Case const& c_;
  StepCosts const& costs_;
  AccuracyOptions const& options_;
  Placement placement_;
  Scene scene_;
  double speed_ = 0;  // typical [m/s]
  std::vector<Item> item_;
  AccuracyPick out_;
};

// Shapes, masses and laws as the run has them; a few nodes are quickly made.
Scene Picker::scene_without_nodes() {
  Case few = c_;
  for (GrainsCase& g : few.grains)
    if (!g.nodes_given) g.nodes = least_nodes;
  return build_scene(few, options_.threads, placement_);
}

void Picker::describe(std::size_t entry) {
  GrainsCase const& g = c_.grains[entry];
  AccuracyPick::Entry& e = out_.entry[entry];
  e.name = g.name, e.nodes = g.nodes, e.given = g.nodes_given;
  std::vector<int> shapes;
  int largest = -1;  // grain: its contacts are the shallowest, in its own d
  for (int i = 0; i < scene_.bodies(); ++i) {
    if (scene_.group_of[i] != static_cast<int>(entry)) continue;
    shapes.push_back(scene_.shape_of[i]);
    if (largest < 0 || scene_.diameter[i] > scene_.diameter[largest]) largest = i;
  }
  if (largest < 0) return;
  std::sort(shapes.begin(), shapes.end());
  shapes.erase(std::unique(shapes.begin(), shapes.end()), shapes.end());
  e.shapes = static_cast<int>(shapes.size());
  int const materials = static_cast<int>(scene_.material.size());
  PressureLaw const law = scene_.contact[scene_.material_of[largest] * (materials + 1)].normal;
  e.exponent = force_exponent(law.kind);
  e.resting = overlap_at_speed(c_, scene_, largest, 0);
  if (!c_.gravity) e.resting = 0;
  double const typical = speed_ > 0 || e.resting > 0 ? overlap_at_speed(c_, scene_, largest, speed_) : fallback_overlap;
  // Two digits: shapes are measured once for cases that differ by less.
  double const wanted = c_.accuracy->overlap.value_or(std::clamp(typical, least_overlap, c_.limits.overlap));
  e.overlap = std::stod(fmt::format("{:.1e}", wanted));
  e.shape = 0;
  int const count = std::min(e.shapes, shapes_an_entry);
  for (int k = 0; k < count; ++k) {
    int const s = shapes[static_cast<std::size_t>(k) * shapes.size() / count];
    // Balls and planes meet in closed form; where nothing else is, there are no nodes.
    if (scene_.shape[s].nodes == 0) continue;
    if (s >= static_cast<int>(scene_.library.shape.size())) continue;  // a compact grain, whose nodes are given
    Shape const& shape = scene_.library.shape[s];
    item_.push_back(
        {static_cast<int>(entry),
         s,
         KnownErrors(scene_.library, shape, law, scene_.diameter[largest], e.overlap, options_.dense_points),
         {}});
    double const own = shape_error(shape, e.overlap, e.exponent);
    e.shape = own < 0 || e.shape < 0 ? -1 : std::max(e.shape, own);
    e.query_ns = std::max(e.query_ns, known_query_ns(scene_.library, shape, costs_));
    ++e.measured;
  }
}

// Of each entry the most that one of its shapes needs; 0: one of them cannot keep the share.
void Picker::choose_nodes(double share, std::vector<int>& nodes) {
  std::vector<int> need(item_.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(options_.threads)
  for (std::size_t i = 0; i < item_.size(); ++i) {
    try {
      AccuracyPick::Entry const& e = out_.entry[item_[i].entry];
      if (e.given) item_[i].errors.at(e.nodes);
      need[i] = e.given ? e.nodes : item_[i].errors.enough(share, options_.most_nodes);
    } catch (std::exception const& error) {
      item_[i].trouble = error.what();
    }
  }
  for (Item const& item : item_)
    if (!item.trouble.empty())
      throw InputError({fmt::format("accuracy: shape '{}' of grains '{}' cannot be measured: {}; give its nodes",
                                    scene_.library.shape[item.shape].name, out_.entry[item.entry].name, item.trouble)});
  nodes.clear();
  for (AccuracyPick::Entry const& e : out_.entry) nodes.push_back(e.given || e.measured == 0 ? e.nodes : least_nodes);
  for (std::size_t i = 0; i < item_.size(); ++i) {
    int& n = nodes[item_[i].entry];
    n = n == 0 || need[i] == 0 ? 0 : std::max(n, need[i]);
  }
}

// As if the scene had so many nodes: the step knows them by their spacing.
StepEstimate Picker::estimate_with(std::vector<int> const& nodes) {
  for (int i = 0; i < scene_.bodies(); ++i) {
    int const s = scene_.shape_of[i];
    if (scene_.shape[s].nodes > 0 && s < static_cast<int>(scene_.library.shape.size()))
      scene_.shape[s].node_spacing = std::sqrt(scene_.library.shape[s].area / nodes[scene_.group_of[i]]);
  }
  return estimate_critical_step(c_, scene_, placement_);
}

double Picker::error_of_step(double safety) const {
  double largest = 0;
  for (ContactCase const& k : c_.contact) largest = std::max(largest, impulse_error(k.law, safety));
  return largest;
}

// Takes this combination where it is cheaper than what was found so far.
void Picker::judge(double safety, std::vector<int> const& nodes) {
  StepEstimate const estimate = estimate_with(nodes);
  double const step =
      c_.time.step ? *c_.time.step : std::min({safety * estimate.critical, estimate.accurate, c_.time.end / 100});
  double us = 0;
  for (int i = 0; i < scene_.bodies(); ++i)  // a closed form is no dearer than the fewest nodes
    us += out_.entry[scene_.group_of[i]].measured == 0
              ? costs_.particle_step_us(least_nodes, 0)
              : costs_.particle_step_us(nodes[scene_.group_of[i]], out_.entry[scene_.group_of[i]].query_ns);
  double const seconds = 1e-6 * us * std::ceil(c_.time.end / step);
  if (out_.safety > 0 && seconds >= out_.seconds) return;
  out_.safety = safety, out_.step = step, out_.seconds = seconds;
  out_.step_us = scene_.bodies() > 0 ? us / scene_.bodies() : 0;
  // What the step really is of the critical one: nodes that enter may ask for a smaller one.
  out_.step_error = std::isfinite(estimate.critical) ? error_of_step(std::min(1.0, step / estimate.critical)) : 0;
  for (std::size_t e = 0; e < nodes.size(); ++e) out_.entry[e].nodes = nodes[e];
}

void Picker::refuse() {
  double reach = 0;
  Item* worst = nullptr;
  for (Item& item : item_) {
    if (out_.entry[item.entry].given) continue;
    double const e = item.errors.at(options_.most_nodes);
    if (!worst || e > reach) reach = e, worst = &item;
  }
  if (!worst)
    throw InputError(
        {fmt::format("accuracy.budget: {} is less than what the time step alone leaves; use step = "
                     "\"auto\" and leave time.safety out",
                     out_.budget)});
  AccuracyPick::Entry const& e = out_.entry[worst->entry];
  throw InputError({fmt::format(
      "accuracy.budget: {:.3g} is not reachable: {} nodes on '{}' of grains '{}' leave {:.2g} in contacts {:.2g} d "
      "deep (sharp edges and light contacts need the most); ask for more than that, for deeper contacts "
      "(accuracy.overlap), or give nodes",
      out_.budget, options_.most_nodes, scene_.library.shape[worst->shape].name, e.name, reach, e.overlap)});
}

AccuracyPick Picker::pick() {
  out_.budget = c_.accuracy->wanted();
  out_.step_given = c_.time.safety_given || c_.time.step;
  out_.entry.resize(c_.grains.size());
  speed_ = 0.5 * estimate_critical_step(c_, scene_, placement_).speed;
  for (std::size_t e = 0; e < c_.grains.size(); ++e) describe(e);
  std::vector<double> tried(std::begin(safeties), std::end(safeties));
  if (out_.step_given) tried = {c_.time.safety};
  std::vector<int> nodes;
  for (double const safety : tried) {
    // A step of the case's own is what it is; the nodes get what it leaves.
    double share = out_.budget - error_of_step(safety);
    if (c_.time.step) share = 0.9 * out_.budget;
    if (share < 0.5 * out_.budget) continue;
    choose_nodes(share, nodes);
    if (std::count(nodes.begin(), nodes.end(), 0) == 0) judge(safety, nodes);
  }
  if (!(out_.safety > 0)) refuse();
  for (Item& item : item_) {
    AccuracyPick::Entry& e = out_.entry[item.entry];
    e.error = std::max(e.error, item.errors.at(e.nodes));
  }
  return out_;
}

}  // namespace

double measure_query_ns(Library const& library, Shape const& shape) {
  std::vector<Vec3> const point = dense_cover(library, shape, 500).position;
  std::vector<double> depth(point.size());
  PhiBatch const phi = fast_phi(library, shape);
  double best = 1e300;  // what others do on the machine only adds
  for (int round = 0; round < 5; ++round) {
    auto const begin = std::chrono::steady_clock::now();
    phi(point, depth, {});
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return 1e9 * best / static_cast<double>(point.size());
}

double StepCosts::particle_step_us(int count, double ns) const {
  auto const at = [&](std::vector<double> const& of) {
    if (nodes.size() < 2) return of.empty() ? 0.0 : of[0];
    std::size_t i = 0;
    while (i + 2 < nodes.size() && nodes[i + 1] < count) ++i;
    double const slope = std::log(of[i + 1] / of[i]) / std::log(double(nodes[i + 1]) / nodes[i]);
    return of[i] * std::pow(double(count) / nodes[i], slope);
  };
  return at(us) + 1e-3 * at(queries) * std::max(0.0, ns - query_ns);
}

double AccuracyPick::error() const {
  double largest = 0;
  for (Entry const& e : entry) largest = std::max(largest, e.error);
  return largest + step_error;
}

AccuracyPick pick_accuracy(Case const& c, StepCosts const& costs, AccuracyOptions const& options) {
  if (!c.accuracy) throw std::invalid_argument("pick_accuracy: the case has no [accuracy]");
  if (std::vector<std::string> found = problems(c); !found.empty()) throw InputError(std::move(found));
  return Picker(c, costs, options).pick();
}

Case with_pick(Case c, AccuracyPick const& pick) {
  for (std::size_t e = 0; e < c.grains.size(); ++e) c.grains[e].nodes = pick.entry.at(e).nodes;
  c.time.safety = pick.safety;
  c.accuracy.reset();
  return c;
}

std::vector<std::string> pick_in_words(AccuracyPick const& pick) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format("accuracy: asked for {:.3g} % of a contact's force, expected {:.2g} % (nodes and step)",
                              100 * pick.budget, 100 * pick.error()));
  for (AccuracyPick::Entry const& e : pick.entry) {
    if (e.shapes == 0) continue;
    std::string line = fmt::format("accuracy: grains '{}': nodes = {}{}", e.name, e.nodes, e.given ? ", as given" : "");
    if (e.measured == 0) {
      lines.push_back(line + "; its contacts have a closed form");
      continue;
    }
    line += fmt::format(", {:.2g} % in contacts {:.2g} % d deep", 100 * e.error, 100 * e.overlap);
    // Errors fall about as (nodes in the contact)^-1.3, and a contact's area is in proportion to its overlap.
    if (e.resting > 0 && e.resting < 0.8 * e.overlap)
      line += fmt::format(", about {:.0f} % at rest ({:.2g} % d)",
                          std::min(100.0, 100 * e.error * std::pow(e.overlap / e.resting, 1.3)), 100 * e.resting);
    line += e.shape < 0 ? "; shape error not known" : fmt::format("; shape error {:.2g} %, apart", 100 * e.shape);
    if (e.measured < e.shapes) line += fmt::format("; measured on {} of its {} shapes", e.measured, e.shapes);
    lines.push_back(line);
  }
  lines.push_back(
      fmt::format("accuracy: time.safety = {}{}, {:.2g} % of a contact's impulse; networks in float, grids "
                  "in float: less than 0.001 %",
                  pick.safety, pick.step_given ? ", as given" : "", 100 * pick.step_error));
  lines.push_back(
      fmt::format("accuracy: predicted {:.3g} us a particle-step and {:.3g} s in all, of one thread's "
                  "processor time",
                  pick.step_us, pick.seconds));
  if (pick.error() > pick.budget)
    lines.push_back("accuracy: warning: more than asked for, because of what the case gives");
  return lines;
}

}  // namespace scree
