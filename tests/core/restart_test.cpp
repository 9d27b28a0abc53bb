// restart_test.cpp: a run stopped anywhere and restarted gives the same bits as one that was never stopped.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "core/checkpoint.h"
#include "core/simulation_impl.h"
#include "tests/support/every_effect.h"
#include "tests/support/same_state.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

class Restart : public ::testing::Test {
 protected:
  Restart() : folder(fs::temp_directory_path() / ("scree_restart_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
  }
  ~Restart() override { fs::remove_all(folder); }
  fs::path folder;
};

bool same_bits(LedgerRow const& a, LedgerRow const& b) { return std::memcmp(&a, &b, sizeof(a)) == 0; }

// The run that is never stopped: its state after every step, as a hash.
struct Reference {
  std::vector<std::size_t> hash;  // after step i
  std::vector<LedgerRow> row;
  std::vector<int> halved;  // steps after which the time step was smaller
  State end;
};

Reference run_through(Case const& c) {
  Reference out;
  Simulation s(c, {});
  out.hash.push_back(hash_of(s.impl().state));
  out.row.push_back(s.ledger());
  while (s.state() == RunState::running) {
    double const before = s.time_step();
    s.step();
    if (s.time_step() < before) out.halved.push_back(static_cast<int>(s.steps()));
    out.hash.push_back(hash_of(s.impl().state));
    out.row.push_back(s.ledger());
  }
  out.end = s.impl().state;
  return out;
}

// Stops at `stops` random steps, and right before and after the time step is halved, goes on from the file each time,
// and compares state and ledger at every step with the run that never stops.
void expect_same_bits(Case const& c, fs::path const& folder, int stops, unsigned seed, Reference const& reference) {
  int const steps = static_cast<int>(reference.hash.size()) - 1;
  std::mt19937 random(seed);
  std::vector<int> stop(stops);
  for (int& at : stop) at = std::uniform_int_distribution(0, steps - 1)(random);
  for (int const at : reference.halved) stop.insert(stop.end(), {at - 1, at});
  std::sort(stop.begin(), stop.end());
  fs::path const file = folder / "checkpoint.h5";
  Simulation first(c, {});
  int rolled = 0, touching = 0;
  for (int const at : stop) {
    while (first.steps() < at) first.step();
    if (first.steps() > at) continue;  // two stops in a row
    write_checkpoint(file, first.checkpoint());
    // Writing one changes nothing.
    ASSERT_EQ(hash_of(first.impl().state), reference.hash[at]) << "at step " << at;
    Simulation second(c, {.threads = at == stop.back() ? 2 : 1});  // any number gives the same bits
    second.restore(read_checkpoint(file));
    ASSERT_EQ(differences(first.impl().state, second.impl().state), "") << "at step " << at;
    EXPECT_TRUE(same_bits(second.ledger(), reference.row[at])) << "at step " << at;
    touching += std::any_of(second.impl().work.result.begin(), second.impl().work.result.end(),
                            [](PairResult const& r) { return r.overlap > 0; });
    for (double const k : second.impl().state.rolling_history.stiffness) rolled += k > 0;
    // Said by name, before hashes of the whole are compared.
    if (first.step() == RunState::running) {
      second.step();
      ASSERT_EQ(differences(first.impl().state, second.impl().state), "") << "one step after step " << at;
    }
    while (second.state() == RunState::running) {
      second.step();
      ASSERT_EQ(hash_of(second.impl().state), reference.hash[second.steps()])
          << "restarted at " << at << ", differs after step " << second.steps();
      ASSERT_TRUE(same_bits(second.ledger(), reference.row[second.steps()])) << "after step " << second.steps();
    }
    EXPECT_EQ(differences(second.impl().state, reference.end), "");
    EXPECT_EQ(second.steps(), steps);
    EXPECT_EQ(second.own_steps(), steps - at);
  }
  // Or there was nothing to remember.
  EXPECT_GT(touching, stops / 3);
  EXPECT_GT(rolled, 0);
  printf("%d steps, %zu restarts, %d of them with contacts\n", steps, stop.size(), touching);
}

// 20 random times over scenes that use every effect.
TEST_F(Restart, NetworksOnAWedge) {
  Case const c = networks_on_a_wedge(folder);
  expect_same_bits(c, folder, 5, 1, run_through(c));
}

TEST_F(Restart, SpheresInADrum) {
  Case const c = spheres_in_a_drum();
  Reference const reference = run_through(c);
  ASSERT_GT(reference.end.deleted.at(0), 0);  // grains did leave
  expect_same_bits(c, folder, 5, 2, reference);
}

TEST_F(Restart, LatticeOfAllKinds) {
  Case const c = lattice_of_all_kinds(folder);
  expect_same_bits(c, folder, 4, 3, run_through(c));
}

TEST_F(Restart, ReplicasOfHarmonics) {
  Case const c = replicas_of_harmonics(folder);
  ASSERT_EQ(Simulation(c, {}).impl().scene.worlds(), 4);
  Reference const reference = run_through(c);
  ASSERT_GT(reference.end.deleted.at(0), 0);
  expect_same_bits(c, folder, 4, 4, reference);
}

// The step is part of the state: a restart neither takes it back nor halves it twice.
TEST_F(Restart, AroundAHalvedTimeStep) {
  Case const c = grains_under_a_press();
  Reference const reference = run_through(c);
  ASSERT_FALSE(reference.halved.empty());
  expect_same_bits(c, folder, 2, 5, reference);
}

// The scenes above leave out nothing that Effects knows.
TEST_F(Restart, ScenesUseEveryEffect) {
  Effects all;
  bool Effects::*const flags[] = {&Effects::sphere_contacts, &Effects::node_contacts,  &Effects::networks,
                                  &Effects::harmonics,       &Effects::grids,          &Effects::meshes,
                                  &Effects::analytic_nodes,  &Effects::friction,       &Effects::rolling,
                                  &Effects::cohesion,        &Effects::damping,        &Effects::gravity,
                                  &Effects::wall_motion,     &Effects::force,          &Effects::drag,
                                  &Effects::global_damping,  &Effects::insertion,      &Effects::deletion,
                                  &Effects::settle,          &Effects::settle_damping, &Effects::measures};
  for (Case const& c : {networks_on_a_wedge(folder), spheres_in_a_drum(), lattice_of_all_kinds(folder),
                        replicas_of_harmonics(folder)}) {
    Simulation s(c, {});
    for (auto const flag : flags) all.*flag = all.*flag || s.impl().effects.*flag;
  }
  for (std::size_t i = 0; i < std::size(flags); ++i) EXPECT_TRUE(all.*flags[i]) << "effect " << i;
  static_assert(sizeof(Effects) == std::size(flags), "Effects has grown: a scene here has to use the new one");
}

}  // namespace
}  // namespace scree
