// hybrid_test.cpp: a run whose networks are evaluated by the device kernel is the host's run, bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <tuple>

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

// Two shipped grains meet in the air; a step is 1e-5 s.
Case meeting(double end) {  // [s]
  Case c = rock_case();
  c.contact[0].friction = 0.5;
  c.library = {{"grains", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}};
  GrainsCase rising = grains_at("grains:ballast/0", {{0, 0, 0}});
  GrainsCase falling = grains_at("grains:sand/1", {{0.0087, 0.01, 0.075}});
  rising.name = "rising", falling.name = "falling";
  rising.insert.velocity = {0, 0, 1}, falling.insert.velocity = {0.5, 0, -1};
  c.grains = {rising, falling};
  c.time.end = end;
  return c;
}

// Nodes that are inside a network's body at this step.
int in_networks(Simulation& s) { return s.impl().work.active.sample.group[s.impl().scene.networks.net.size()]; }

class Hybrid : public SameBitsOnNetworkDevices {};

TEST_P(Hybrid, RunEqualsTheHostsBitForBit) {
  for (Case const& c : {meeting(6e-4), shower(2e3)}) {
    SimulationOptions on_device;
    on_device.network_device = device_;
    Simulation host(c, {}), hybrid(c, on_device);
    std::size_t contacts = 0;
    int inside = 0;
    while (host.step() == RunState::running) {
      hybrid.step();
      contacts += hybrid.impl().work.active.node.size();
      inside += in_networks(hybrid);
    }
    hybrid.step();
    EXPECT_GT(contacts, 100u);
    if (c.wall.empty()) {
      EXPECT_GT(inside, 100) << "of grains that meet";
    }
    auto const expected = bytes_of(host.impl().state), found = bytes_of(hybrid.impl().state);
    for (auto const& [name, bytes] : expected) EXPECT_EQ(bytes == found.at(name), true) << name << " differs";
  }
}

class HalfHybrid : public OnNetworkDevices {};

// Not the same bits. fp16x3 moves phi by 3e-7 d at most, of contacts 1e-2 d deep: forces by 3e-5 of themselves, and
// poses by that share of the 0.02 d that contact adds to the way. One pass of fp16 moves a surface by 1e-3 d, and with
// it poses at most; energies by the work on that way, a tenth of the largest force's.
TEST_P(HalfHybrid, RunStaysWithTheHostsAsCloselyAsItsPrecisionAllows) {
  for (auto [precision, poses, energies] :
       {std::tuple(Precision::fp16x3, 1e-6, 1e-5), std::tuple(Precision::fast, 1e-3, 5e-3)}) {
    SCOPED_TRACE(to_string(precision));
    Case c = meeting(1.25e-3);
    Simulation host(c, {});
    c.device = DeviceCase{precision};
    SimulationOptions on_device;
    on_device.network_device = device_;
    Simulation half(c, on_device);
    int contacts = 0;
    while (host.step() == RunState::running) {
      half.step();
      contacts += in_networks(half);
    }
    half.step();
    EXPECT_GE(host.steps(), 100);
    EXPECT_GT(contacts, 100);
    double apart = 0;
    Frame const a = host.frame(), b = half.frame();
    for (std::size_t i = 0; i < a.position.size(); ++i)
      apart = std::max(apart, norm(a.position[i] - b.position[i]) / 0.1);  // [d]
    LedgerRow const e = host.ledger(), f = half.ledger();
    EXPECT_LE(apart, poses);
    EXPECT_GT(apart, 0) << "the half precision took no part";
    EXPECT_NEAR(f.kinetic, e.kinetic, energies * e.kinetic);
    EXPECT_LE(std::abs(f.residual), std::abs(e.residual) + energies * e.moved);
  }
}

// The shipped decoders' phi within 1e-6 d, and no node inside that the filter rejects.
TEST_P(HalfHybrid, ShippedNetworksKeepTheirSurface) {
  Case const c = meeting(1.25e-3);
  Simulation host(c, {});
  Scene& scene = host.impl().scene;
  QueryBatch exact;
  exact.group.assign(query_groups(static_cast<int>(scene.networks.net.size())) + 1, 0);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int net = 0; net < static_cast<int>(scene.networks.net.size()); ++net) {
    for (int body = 0; body < scene.bodies(); ++body) {
      ShapeRecord const& shape = scene.view().shape_record(body);
      for (int i = 0; shape.net == net && i < 1000; ++i) {
        exact.point.push_back(Vec3{uniform(random), uniform(random), uniform(random)} * shape.bounding_radius);
        exact.partner.push_back(body);
      }
    }
    for (std::size_t g = net + 1; g < exact.group.size(); ++g) exact.group[g] = static_cast<int>(exact.point.size());
  }
  std::size_t const n = exact.point.size();
  ASSERT_GE(n, 2000u);
  exact.phi.resize(n), exact.gradient.resize(n);
  QueryBatch filtered = exact, all = exact;
  evaluate_phi_gradient({}, scene.view(), scene.networks, exact);
  device_->load(scene.view(), scene.networks, Precision::fp16x3);
  device_->evaluate({}, all, -INFINITY);
  device_->evaluate({}, filtered, 0);
  double largest = 0, high = 0;
  int inside = 0, turned = 0;
  for (std::size_t i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(all.phi[i] - exact.phi[i]));
    ASSERT_GE(filtered.phi[i], all.phi[i]);
    high = std::max(high, filtered.phi[i] - all.phi[i]);
    if (!(all.phi[i] > 0)) continue;
    ++inside;
    ASSERT_EQ(filtered.phi[i], all.phi[i]);
    ASSERT_EQ(filtered.gradient[i], all.gradient[i]);
    turned += norm(all.gradient[i] - exact.gradient[i]) > 1e-5;  // on the two sides of a leaky ReLU's kink
  }
  EXPECT_LE(largest, 1e-6);
  EXPECT_GT(inside, 400);
  EXPECT_LT(high, 2e-2) << "a filter that keeps what is further outside than grains reach into one another";
  EXPECT_LE(turned, inside / 200);
}

INSTANTIATE_TEST_SUITE_P(Devices, HalfHybrid, network_devices, network_device_name);
INSTANTIATE_TEST_SUITE_P(Devices, Hybrid, network_devices, network_device_name);

}  // namespace
}  // namespace scree
