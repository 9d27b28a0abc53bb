// network_device_test.cpp: the fused device kernel against the host evaluator, bit for bit, through its emulator and,
// where there is one, on a GPU.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/network_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/ball_walk.h"
#include "kernels/base/device.h"
#include "kernels/sdf/mlp_fused.h"
#include "kernels/sdf_queries.h"
#include "tests/support/network_bodies.h"
#include "tests/support/network_devices.h"
#include "tests/support/random_mlp.h"

namespace scree {
namespace {

using test::Bodies;
using test::random_mlp;
using test::widths;
using testing::host_fuses;

double constexpr everywhere = -std::numeric_limits<double>::infinity(), nowhere = -everywhere;

class NetworkDeviceTest : public testing::OnNetworkDevices {
 protected:
  void expect_equal_to_host(Bodies const& bodies, int each) {
    QueryBatch host = bodies.queries(each), on_device = host, phi_only = host;
    evaluate_phi_gradient({}, bodies.view(), bodies.networks, host);
    device_->load(bodies.view(), bodies.networks);
    device_->evaluate({}, on_device, everywhere);
    device_->evaluate({}, phi_only, nowhere);
    double largest = 0;
    for (Vec3 const& g : host.gradient) largest = std::max(largest, norm(g));
    for (std::size_t i = 0; i < host.point.size(); ++i) {
      ASSERT_EQ(on_device.phi[i], phi_only.phi[i]) << "point " << i;
      // 1e-5: promised by sdf_batch.h; the host without fused multiply-adds differs by float rounding.
      ASSERT_NEAR(on_device.phi[i], host.phi[i], host_fuses() ? 0 : 1e-5) << "point " << i;
      bool const beyond = norm(host.point[i]) > 0.6 && !(bodies.cohesion_reach > 0);  // no gradient is defined there
      if (host_fuses() && !beyond) {
        ASSERT_EQ(on_device.gradient[i], host.gradient[i]) << "point " << i;
      }
      ASSERT_EQ(phi_only.gradient[i].x, 77) << "nobody asked for gradients";
    }
    EXPECT_GT(largest, 0.1);
  }
};

TEST_P(NetworkDeviceTest, EqualsTheHostForEveryActivationWidthAndDepth) {
  for (auto [activation, parameter] : {std::pair(Activation::leaky_relu, 0.01), std::pair(Activation::sine, 5.0),
                                       std::pair(Activation::softplus, 20.0)})
    for (int width : {8, 16, 30, 40, 48, 50, 64})
      for (int depth : {1, 2, 5, 8}) {
        SCOPED_TRACE(std::string(to_string(activation)) + " " + std::to_string(depth) + " x " + std::to_string(width));
        Bodies bodies;
        bodies.add(random_mlp(activation, parameter, widths(3, width, depth), width + depth), 1);
        expect_equal_to_host(bodies, 70);
      }
}

// Many networks of several classes in one batch, codes that alternate within a tile, unequal widths; counts round the
// size of a tile.
TEST_P(NetworkDeviceTest, EqualsTheHostForManyNetworksAndShapesInOneBatch) {
  int constexpr tile = sdf_fused::tile_points;
  Bodies bodies;
  bodies.add(random_mlp(Activation::sine, 5, {13, 40, 40, 40, 1}, 1), 3);
  bodies.add(random_mlp(Activation::leaky_relu, 0.01, {3, 40, 17, 64, 8, 33, 1}, 2), 1);
  bodies.add(random_mlp(Activation::sine, 5, {3, 30, 30, 1}, 3), 1);
  bodies.add(random_mlp(Activation::sine, 8, {5, 38, 39, 1}, 4), 2);
  for (int each : {0, 1, 31, 32, tile - 1, tile, tile + 1, 700}) {
    SCOPED_TRACE(each);
    if (each > 0) {
      expect_equal_to_host(bodies, each);
      continue;
    }
    QueryBatch none = bodies.queries(0);
    device_->load(bodies.view(), bodies.networks);
    device_->evaluate({}, none, everywhere);
  }
  bodies.cohesion_reach = 1e-3;
  expect_equal_to_host(bodies, 300);
}

// Gradients in the same launch where phi d is above the bound, and nowhere else.
TEST_P(NetworkDeviceTest, MakesGradientsOnlyWhereTheyAreWanted) {
  Bodies bodies;
  bodies.add(random_mlp(Activation::sine, 5, {13, 40, 40, 40, 1}, 1), 4);
  QueryBatch host = bodies.queries(500), some = host;
  evaluate_phi_gradient({}, bodies.view(), bodies.networks, host);
  device_->load(bodies.view(), bodies.networks);
  for (double from : {0.0, -0.01, 1e9}) {
    some.gradient.assign(some.point.size(), {77, 77, 77});
    device_->evaluate({}, some, from);
    int made = 0;
    for (std::size_t i = 0; i < some.point.size(); ++i) {
      bool const wanted = some.phi[i] * bodies.diameter[some.partner[i]] > from;
      made += wanted;
      bool const beyond = norm(some.point[i]) > 0.6;
      if (wanted && host_fuses() && !beyond) {
        ASSERT_EQ(some.gradient[i], host.gradient[i]) << "point " << i;
      }
      if (!wanted && std::string(GetParam()) == "emulated") {  // a GPU's come back with what was there
        ASSERT_EQ(some.gradient[i].x, 77) << "point " << i;
      }
    }
    if (from < 1) {
      EXPECT_GT(made, 100);
    }
  }
}

// Steps along rays: those of a launch are those made one by one with the host's phi; what is over stays as it is.
TEST_P(NetworkDeviceTest, WalksAsTheHostDoesStepByStep) {
  if (!host_fuses()) GTEST_SKIP() << "this CPU has no fused multiply-add: equal to float rounding only";
  Bodies bodies;
  bodies.add(random_mlp(Activation::sine, 5, {13, 40, 40, 40, 1}, 1), 3);
  bodies.add(random_mlp(Activation::leaky_relu, 0.01, {3, 30, 30, 1}, 2), 1);
  bodies.add(random_mlp(Activation::softplus, 20, {5, 24, 1}, 5), 2);
  for (std::size_t s = 0; s < bodies.shape.size(); ++s) bodies.shape[s].lipschitz = 2 + 0.3 * s;
  QueryBatch ask = bodies.queries(90);  // more than a tile of some networks, less of others
  int const n = static_cast<int>(ask.point.size());
  auto const aim = test::random_points(n, 0.3, 8);
  WalkBatch device;
  for (int i = 0; i < n; ++i) {
    device.origin.push_back(ask.point[i]);
    device.direction.push_back(normalized(to_double(aim[i]) - ask.point[i]));
    device.end.push_back(0.3 * (i % 4));
  }
  device.body = ask.partner;
  device.group = ask.group;
  device.at.assign(n, 0);
  device.step.assign(n, 0);
  WalkBatch host = device;
  device_->load(bodies.view(), bodies.networks);
  for (int most : {0, 1, 7, walk_steps}) {
    device_->walk({}, device, most);
    for (int k = 0; k < most; ++k) {
      for (int i = 0; i < n; ++i) ask.point[i] = host.origin[i] + host.direction[i] * host.at[i];
      evaluate_phi({}, bodies.view(), bodies.networks, ask);
      for (int i = 0; i < n; ++i)
        if (host.step[i] >= 0)
          walk_on(ask.phi[i], bodies.shape[bodies.shape_of[host.body[i]]].lipschitz, host.end[i], host.at[i],
                  host.step[i]);
    }
    ASSERT_EQ(device.step, host.step) << "after " << most << " more";
    ASSERT_EQ(device.at, host.at) << "after " << most << " more";
  }
  auto const count = [&](int step) { return std::count(device.step.begin(), device.step.end(), step); };
  EXPECT_GT(count(walk_hit), n / 10);
  EXPECT_GT(count(walk_left), n / 10);
  EXPECT_EQ(count(walk_hit) + count(walk_left), n) << "walk_steps is the most any takes";
  WalkBatch none;
  none.group.assign(bodies.networks.net.size() + 1, 0);
  device_->walk({}, none, 5);
}

// A mark moves a point to the pass with gradients and changes no bits; on a device phi decides, whatever was marked.
TEST_P(NetworkDeviceTest, MarkedPointsGetTheirGradientInTheSamePass) {
  Bodies bodies;
  bodies.add(random_mlp(Activation::sine, 5, {13, 40, 40, 40, 1}, 1), 3);
  bodies.add(random_mlp(Activation::leaky_relu, 0.01, {3, 30, 30, 1}, 2), 1);
  QueryBatch whole = bodies.queries(500), untouched = whole;
  evaluate_phi_gradient({}, bodies.view(), bodies.networks, whole);
  device_->load(bodies.view(), bodies.networks);
  std::shared_ptr<NetworkDevice> const device = std::move(device_);
  for (bool on_device : {false, true}) {
    bodies.networks.device = on_device ? device : nullptr;
    QueryBatch marked = untouched;
    std::vector<char> graded(marked.point.size());
    for (std::size_t i = 0; i < graded.size(); ++i) graded[i] = i % 3 == 0;
    std::vector<char> const asked = graded;
    evaluate_phi_and_marked_gradients({}, bodies.view(), bodies.networks, marked, graded, 0.0);
    int made = 0;
    for (std::size_t i = 0; i < graded.size(); ++i) {
      ASSERT_NEAR(marked.phi[i], whole.phi[i], host_fuses() ? 0 : 1e-5) << "point " << i;
      ASSERT_EQ(bool(graded[i]), on_device ? marked.phi[i] > 0 : bool(asked[i])) << "point " << i;
      if (graded[i] && host_fuses() && norm(marked.point[i]) <= 0.6) {
        ASSERT_EQ(marked.gradient[i], whole.gradient[i]) << "point " << i;
      }
      if (!graded[i] && !on_device) {
        ASSERT_EQ(marked.gradient[i].x, 77) << "nobody asked for it";
      }
      made += graded[i];
    }
    EXPECT_GT(made, 100);
  }
}

TEST_P(NetworkDeviceTest, RefusesNetworksThatAreTooDeep) {
  Bodies bodies;
  bodies.add(random_mlp(Activation::sine, 5, widths(3, 16, sdf_fused::max_hidden + 1), 1), 1);
  EXPECT_THROW(device_->load(bodies.view(), bodies.networks), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Devices, NetworkDeviceTest, testing::network_devices, testing::network_device_name);

TEST(CudaDevice, AbsenceIsSaidWithTheWayOut) {
  try {
    CudaDevice const device = cuda_device();
    EXPECT_NE(describe(device).find(device.name), std::string::npos);
  } catch (DeviceError const& error) {
    std::string const text = error.what();
    EXPECT_TRUE(text.find("SCREE_CUDA") != std::string::npos || text.find("--device cpu") != std::string::npos) << text;
  }
}

}  // namespace
}  // namespace scree
