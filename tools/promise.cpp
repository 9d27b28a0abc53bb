// promise.cpp: see promise.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/promise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/contact_errors.h"
#include "core/simulation_impl.h"
#include "shapes/random.h"

namespace scree {
namespace {

Case case_of(PromiseSetting const& s, std::filesystem::path const& library) {
  Case c;
  c.name = "promise";
  if (s.shape.starts_with("grains:")) c.library = {{"grains", library}};
  c.material = {{"rock", 2650}};
  ContactCase contact;
  contact.pair = {"rock", "rock"};
  contact.law = s.law;
  contact.stiffness = s.stiffness;
  contact.youngs_modulus = s.stiffness / s.diameter;
  contact.poisson_ratio = 0.25;
  c.contact = {contact};
  GrainsCase g;
  g.name = "grain";
  g.material = "rock";
  g.shapes = {s.shape};
  g.evaluator = s.evaluator;
  g.grid_cells = s.cells;
  g.diameter = s.diameter;
  g.insert.kind = InsertCase::Kind::list;
  c.grains = {g};
  c.time.end = 1;
  c.accuracy = AccuracyCase{s.budget, AccuracyPreset::none, s.overlap};
  return c;
}

// Pairs in a row, far from each other.
void place(std::vector<ContactPose> const& contact, double d, double reach, InsertCase& insert) {
  for (std::size_t k = 0; k < contact.size(); ++k) {
    Vec3 const at{8 * reach * d * static_cast<double>(k), 0, 0};
    insert.position.insert(insert.position.end(), {at, at + contact[k].shift * d});
    insert.quaternion.insert(insert.quaternion.end(), {Quat{}, contact[k].turn});
  }
}

}  // namespace

PromiseSetting promise_setting(int seed, int index, bool networks) {
  Random random(1000000 * static_cast<std::uint64_t>(seed) + static_cast<std::uint64_t>(index));
  auto const between = [&](double low, double high) { return low * std::pow(high / low, random.uniform()); };
  PromiseSetting s;
  s.diameter = between(1e-3, 1);
  s.stiffness = between(1e5, 1e8);
  s.overlap = between(0.003, 0.05);
  s.budget = between(0.003, 0.1);
  ContactLaw const laws[] = {ContactLaw::winkler, ContactLaw::winkler, ContactLaw::hertz};
  s.law = laws[random.below(3)];
  std::string const ellipsoid = fmt::format("ellipsoid:{:.3f}:{:.3f}:1", random.uniform(1, 2), random.uniform(1, 1.5));
  char const* const categories[] = {"ballast", "cobble", "ellipsoid", "sand"};
  std::string const net = fmt::format("grains:{}/{}", categories[random.below(4)], random.below(4));
  switch (networks ? index % 6 : index % 2) {
    case 0:
      s.shape = ellipsoid, s.evaluator = Evaluator::analytic;
      break;
    case 1:
      s.shape = ellipsoid, s.evaluator = Evaluator::grid, s.cells = 32 + random.below(40);
      break;
    case 2:
    case 4:
      s.shape = net;
      break;
    case 3:
      s.shape = net, s.evaluator = Evaluator::grid, s.cells = 32 + random.below(40);
      break;
    default:  // whose distance takes a thousand times longer: every other time
      s.evaluator = Evaluator::analytic;
      s.shape = index % 12 == 5
                    ? ellipsoid
                    : fmt::format("superellipsoid:{:.3f}:1:0.8:{:.2f}", random.uniform(1, 1.5), random.uniform(0.6, 1));
  }
  return s;
}

PromiseResult try_promise(PromiseSetting const& setting, PromiseOptions const& options, std::uint64_t seed) {
  PromiseResult out;
  out.setting = setting;
  Case c = case_of(setting, options.library);
  Case few = c;
  few.accuracy.reset();
  few.grains[0].nodes = 250;
  few.grains[0].insert.position = {{}};
  few.grains[0].count = 1;
  Placement ignored;
  Scene const scene = build_scene(few, options.accuracy.threads, ignored);
  Shape const& shape = scene.library.shape[0];
  SurfaceCover const dense = dense_cover(scene.library, shape, options.accuracy.dense_points);
  PhiBatch const fast = fast_phi(scene.library, shape);
  std::vector<ContactPose> const contact = draw_contacts(fast, shape, dense, options.contacts, setting.overlap, seed);
  place(contact, setting.diameter, shape.bounding_radius, c.grains[0].insert);
  c.grains[0].count = static_cast<int>(c.grains[0].insert.position.size());
  try {
    AccuracyPick const pick = pick_accuracy(c, options.costs, options.accuracy);
    c = with_pick(c, pick);
    out.nodes = pick.entry[0].nodes;
    out.expected = pick.entry[0].error;
  } catch (InputError const& error) {
    out.refused = error.what();
    return out;
  }
  Simulation simulation(c, {.threads = options.accuracy.threads});
  ContactPhi const phi{fast, reference_phi(scene.library, shape)};
  double const d = setting.diameter;
  std::vector<double> error(contact.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(options.accuracy.threads)
  for (std::size_t k = 0; k < contact.size(); ++k) {
    // Equal balls of the diameter have R* = d/4, which Hertz's law is for.
    PressureLaw const law = law_at_radius(scene.contact[0].normal, d / 4);
    Vec3 const whole = contact_force(phi, shape, dense, contact[k], law, d) * (d * d);
    error[k] = norm(simulation.impl().state.wrench.elastic[2 * k + 1].force - whole) / norm(whole);
  }
  std::sort(error.begin(), error.end());
  auto const n = static_cast<double>(error.size());
  out.median = error[static_cast<std::size_t>(n / 2)];
  out.p95 = error[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
  out.largest = error.back();
  out.within = static_cast<int>(std::upper_bound(error.begin(), error.end(), setting.budget) - error.begin());
  return out;
}

std::string promise_csv(std::vector<PromiseResult> const& results) {
  std::string text =
      "shape,evaluator,cells,law,diameter_m,stiffness,overlap_d,budget,nodes,expected,median,p95,largest,"
      "within,kept\n";
  for (PromiseResult const& r : results) {
    PromiseSetting const& s = r.setting;
    char const* const evaluator = s.evaluator == Evaluator::grid       ? "grid"
                                  : s.evaluator == Evaluator::analytic ? "formula"
                                                                       : "net";
    text += fmt::format("{},{},{},{},{:.4g},{:.4g},{:.4g},{:.4g},", s.shape, evaluator,
                        s.evaluator == Evaluator::grid ? s.cells : 0, s.law == ContactLaw::hertz ? "hertz" : "winkler",
                        s.diameter, s.stiffness, s.overlap, s.budget);
    text += r.refused.empty() ? fmt::format("{},{:.4g},{:.4g},{:.4g},{:.4g},{},{}\n", r.nodes, r.expected, r.median,
                                            r.p95, r.largest, r.within, r.kept() ? "yes" : "no")
                              : "refused,,,,,,\n";
  }
  return text;
}

}  // namespace scree
