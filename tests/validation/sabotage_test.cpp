// sabotage_test.cpp: deliberately wrong physics has to fail the book: each entry runs sound first, then with the flaw.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/tangential.h"
#include "tests/support/cases.h"
#include "tests/validation/entries.h"

namespace scree::book {
namespace {

using namespace testing;

int figures_outside(Entry const& book) {
  return static_cast<int>(
      std::count_if(book.rows().begin(), book.rows().end(), [](Row const& r) { return !r.passed(); }));
}

// `entry` adds the rows of an entry with a flaw, or with none. Both results stand in the book.
template <class F>
void expect_noticed(std::string const& title, std::function<void(Entry&, F const&)> const& entry, F const& sound,
                    F const& wrong) {
  Entry book("validation", "sabotage", title, "the same entry without and with the flaw");
  auto const run = [&](F const& how) {
    Entry rows("validation", "sabotage", title, "");
    rows.expect_to_fail();
    try {
      entry(rows, how);
    } catch (WatchStop const&) {  // would end an entry's test
      rows.at_most("a watch stopped the run", "", 1, 0);
    }
    return std::pair{figures_outside(rows), static_cast<int>(rows.rows().size())};
  };
  auto const [outside_sound, figures] = run(sound);
  auto const [outside_wrong, figures_wrong] = run(wrong);
  book.at_least("figures of the entry", "", figures, 1);
  book.absolute("figures outside, sound", "", 0, outside_sound, 0);
  book.at_least("figures outside, with the flaw", "", outside_wrong, 1);
}

using FlawedEntry = std::function<void(Entry&, Flaw const&)>;

Encounter ellipsoids() { return {"ellipsoid:1:0.8:0.6", "ellipsoid:1:0.8:0.6"}; }

void collide_ellipsoids(Entry& book, Flaw const& flaw) {
  frictionless_collisions(book, "ellipsoid", {ellipsoids()}, 1e-4, flaw);
}

TEST(Sabotage, FlippedSignOfTheDamping) {
  FlawedEntry const entry = [](Entry& book, Flaw const& flaw) { add_rebound(book, "sphere", {}, flaw); };
  expect_noticed("the damping's sign is flipped", entry, {}, Flaw{[](Simulation::Impl& s) {
                   for (ContactParameters& p : s.scene.contact) p.damping_nodes *= -1;
                 }});
}

TEST(Sabotage, FlippedSignOfATorque) {
  Flaw flaw;
  flaw.after_step = [](Simulation::Impl& s) { s.state.wrench.elastic[1].torque *= -1; };  // the next step opens with it
  expect_noticed("the torque on one grain has the wrong sign", FlawedEntry(collide_ellipsoids), {}, flaw);
}

TEST(Sabotage, NormalisedGradientOnAWarpedPhi) {
  FlawedEntry const entry = [](Entry& book, Flaw const& flaw) {
    std::vector<Encounter> poses;  // one alone may turn so little that the flaw hides
    for (unsigned seed = 0; seed < 5; ++seed)
      poses.push_back({"warped:warped", "warped:warped", {warped_library()}, seed, 2});
    frictionless_collisions(book, "warped", poses, 3e-4, flaw);
  };
  expect_noticed("the gradient of phi is normalised", entry, {},
                 Flaw{[](Simulation::Impl& s) { s.contacts.normalise_gradient = true; }});
}

TEST(Sabotage, BlocksOfNodesCulledByTheirCentres) {
  expect_noticed(
      "blocks of nodes are culled as if they were points", FlawedEntry(collide_ellipsoids), {},
      Flaw{[](Simulation::Impl& s) { std::fill(s.scene.block_radius.begin(), s.scene.block_radius.end(), 0); }});
}

TEST(Sabotage, NodesCulledBeyondTheLipschitzBound) {
  expect_noticed("nodes wait as if phi rose at a quarter of its slope", FlawedEntry(collide_ellipsoids), {},
                 Flaw{[](Simulation::Impl& s) {
                   for (ShapeRecord& shape : s.scene.shape) shape.lipschitz *= 0.25;
                 }});
}

TEST(Sabotage, PairListThatIsNeverRenewed) {
  Flaw flaw;
  flaw.after_step = [](Simulation::Impl& s) { std::fill(s.work.skin.begin(), s.work.skin.end(), 1e9); };
  expect_noticed("the pair list outlives its skin", FlawedEntry(collide_ellipsoids), {}, flaw);
}

TEST(Sabotage, HistoryEntryLostOnRestart) {
  Flaw flaw;
  flaw.at_restart = [](Checkpoint& checkpoint) {
    for (Vec3& xi : checkpoint.state.node_history.xi)
      if (norm2(xi) > 0) {
        xi = {};
        return;
      }
  };
  FlawedEntry const entry = [](Entry& book, Flaw const& f) { block_on_incline(book, Evaluator::analytic, f); };
  expect_noticed("one node's tangential history is lost on restart", entry, {}, flaw);
}

TEST(Sabotage, HistoryProjectedButNotTurned) {
  std::function<void(Entry&, Transport const&)> const entry = history_turns_with_the_pair;
  expect_noticed("the tangential history is projected, but not turned with the pair", entry, Transport(transport),
                 Transport([](Vec3 xi, Mat3 const&, Vec3 n) { return transport(xi, to_matrix(Quat{}), n); }));
}

TEST(Sabotage, CoreNodesDropped) {
  FlawedEntry const entry = [](Entry& book, Flaw const& flaw) {
    energy_of_approach(book, "ellipsoid", grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 0}}), {}, 1e-9, flaw);
  };
  expect_noticed("nodes on the surface alone", entry, {}, Flaw{[](Simulation::Impl& s) {
                   Scene& scene = s.scene;
                   for (std::size_t k = 0; k < scene.shape.size(); ++k)
                     for (int i = 0; i < scene.shape[k].nodes; ++i) {
                       int const node = scene.shape[k].first_node + i;
                       double const phi =
                           evaluate_reference(scene.library, scene.library.shape[k], scene.node_position[node]);
                       if (phi > 0.05) scene.node_area[node] = 0;  // [d]: far below the surface
                     }
                 }});
}

}  // namespace
}  // namespace scree::book
