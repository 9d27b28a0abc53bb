// approach_entries.cpp: row 7d of the book: the contact energy of two grains grows all the way to coincidence.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <vector>

#include "core/contacts.h"
#include "tests/support/cases.h"
#include "tests/validation/entries.h"

namespace scree::book {

using namespace testing;

void energy_of_approach(Entry& book, std::string const& name, GrainsCase const& grain,
                        std::vector<LibraryCase> const& library, double allowed, Flaw const& flaw) {
  double const d = grain.diameter;
  Case c = rock_case();
  c.library = library;
  GrainsCase a = grain, b = grain;
  a.insert.position = {{0, 0, 0}}, b.insert.position = {{10 * d, 0, 0}};
  b.name = "other";
  c.grains = {a, b};
  Simulation s(c, {});
  flaw.start(s);
  Simulation::Impl& impl = s.impl();
  ContactSettings every_node = impl.contacts;
  every_node.brute_force = true;  // the pair jumps
  double const reach = 2 * impl.scene.shape[impl.scene.shape_of[0]].bounding_radius * d;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  int const steps = full() ? 100 : 40, ways = full() ? 12 : 4;
  double worst = 0, turned_over_at = 0;
  for (int way = 0; way < ways; ++way) {
    // Along an axis with like poses first, then along random directions at random poses.
    Vec3 const from = way == 0 ? Vec3{0, 0, 1} : normalized(Vec3{u(random), u(random), u(random)});
    Quat const q = way < 2 ? Quat{} : normalized(Quat{u(random), u(random), u(random), u(random)});
    impl.state.orientation[0] = Quat{};
    impl.state.orientation[1] = q;
    impl.state.position[0] = {};
    std::vector<double> energy;
    for (int i = 0; i <= steps; ++i) {
      impl.state.position[1] = from * (reach * (steps - i) / steps);
      evaluate_contacts(impl.queue, impl.scene, impl.effects, every_node, 0, impl.state, impl.work);
      double sum = 0;
      for (PairResult const& r : impl.work.result) sum += r.energy_normal;
      energy.push_back(sum);
    }
    double const largest = *std::max_element(energy.begin(), energy.end());
    double fallen = 0;
    for (int i = 1; i <= steps; ++i) {
      double const fall = (energy[i - 1] - energy[i]) / largest;
      if (fall > 1e-9) turned_over_at = std::max(turned_over_at, reach * (steps - i) / steps / d);
      fallen += std::max(0.0, fall);
    }
    worst = std::max(worst, fallen);
    if (way == 0)
      for (int i = 0; i <= steps; ++i)
        book.point("contact energy [J] against distance of the centres [d], " + name, reach * (steps - i) / steps / d,
                   std::nan(""), energy[i]);
  }
  book.at_most(name + ": energy lost on the way in, of its largest", "", worst, allowed);
  book.trend(name + ": outermost distance at which it falls", "d", turned_over_at);
}

namespace {

GrainsCase grain_of(std::string const& shape, Evaluator evaluator = Evaluator::net, int nodes = full() ? 4000 : 1000) {
  GrainsCase g = grains_at(shape, {{0, 0, 0}}, 0.1, nodes);
  g.evaluator = evaluator;
  return g;
}

// Of the largest energy. Sums over nodes round; a grid of 43 cells (0.03 d) cuts the ridge of phi, about 0.4 d high
// where the core nodes are, by up to a quarter of a cell, and the energy goes with its square: 2 x 0.0075 / 0.4.
double constexpr rounding = 1e-9, ridges = 0.04;

TEST(Validation, Row7dEnergyGrowsToCoincidence) {
  Entry book("validation", "7d", "contact energy of two equal grains against their approach",
             "design: monotone to the centre, so that deep overlaps push apart");
  std::vector<LibraryCase> const shipped = {
      {"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  energy_of_approach(book, "sphere with nodes", grain_of("ellipsoid:1:1:1"), {}, rounding);
  energy_of_approach(book, "superellipsoid", grain_of("superellipsoid:1:0.8:0.6:0.5"), {}, rounding);
  energy_of_approach(book, "cube", grain_of("box:1:1:1"), {}, rounding);
  energy_of_approach(book, "plate 5:5:1", grain_of("box:5:5:1"), {}, rounding);
  energy_of_approach(book, "ballast network", grain_of("grains:ballast/0"), shipped, rounding);
  energy_of_approach(book, "ballast as grid", grain_of("grains:ballast/0", Evaluator::grid), shipped, ridges);
  energy_of_approach(book, "cube as mesh", grain_of("box:1:1:1", Evaluator::mesh), {}, rounding);
}

}  // namespace
}  // namespace scree::book
