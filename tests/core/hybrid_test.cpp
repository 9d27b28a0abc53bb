// hybrid_test.cpp: a run whose networks are evaluated by the device kernel is the host's run, bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "core/simulation_impl.h"
#include "kernels/base/device.h"
#include "tests/support/cases.h"
#include "tests/support/network_devices.h"
#include "tests/support/same_state.h"

namespace scree {
namespace {

using namespace testing;

// Shipped grains of two kinds fall into a box with a sphere that needs no network.
Case shower(double cohesion) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.7;
  if (cohesion > 0) c.contact[0].cohesion = CohesionCase{cohesion, 2e-3};
  c.library = {{"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  GrainsCase g = grains_at("sphere", {}, 0.1, 250);
  g.shapes = {"grains:ballast/0", "grains:sand/1", "sphere"};
  g.count = 6;
  g.insert.kind = InsertCase::Kind::lattice;
  g.insert.orientation = Orientation::random;
  g.insert.velocity = {0.8, 0.4, -4};
  g.insert.box = {{0, 0, 0}, {0.28, 0.28, 1.2}};
  c.grains = {g};
  c.wall = {open_box({0, 0, 0}, {0.28, 0.28, 2})};
  c.time.end = 0.01;
  return c;
}

class Hybrid : public SameBitsOnNetworkDevices {};

TEST_P(Hybrid, RunEqualsTheHostsBitForBit) {
  for (double cohesion : {0.0, 2e3}) {
    Case const c = shower(cohesion);
    SimulationOptions on_device;
    on_device.network_device = device_;
    Simulation host(c, {}), hybrid(c, on_device);
    std::size_t contacts = 0;
    while (host.step() == RunState::running) {
      hybrid.step();
      contacts += hybrid.impl().work.active.node.size();
    }
    hybrid.step();
    EXPECT_GT(contacts, 100u);
    auto const expected = bytes_of(host.impl().state), found = bytes_of(hybrid.impl().state);
    for (auto const& [name, bytes] : expected) EXPECT_EQ(bytes == found.at(name), true) << name << " differs";
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, Hybrid, network_devices, network_device_name);

}  // namespace
}  // namespace scree
