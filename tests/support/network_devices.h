// network_devices.h: tests that every device for networks has to pass: the emulated one, and a GPU where there is one.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "kernels/base/device.h"
#include "kernels/network_device.h"
#include "kernels/sdf/sdf_batch.h"

namespace scree::testing {

// The host's instruction set rounds a b + c once, as the device does; its portable fallback rounds twice.
inline bool host_fuses() { return sdf_isa() != "generic"; }

class OnNetworkDevices : public ::testing::TestWithParam<char const*> {
 protected:
  void SetUp() override {
    if (std::string(GetParam()) == "emulated") {
      device_ = make_emulated_network_device();
      return;
    }
    try {
      device_ = make_cuda_network_device();
    } catch (DeviceError const& error) {
      GTEST_SKIP() << error.what();
    }
  }
  std::shared_ptr<NetworkDevice> device_;
};

// The same, for tests that compare bits with the host's.
class SameBitsOnNetworkDevices : public OnNetworkDevices {
 protected:
  void SetUp() override {
    if (!host_fuses()) GTEST_SKIP() << "this CPU has no fused multiply-add: equal to float rounding only";
    OnNetworkDevices::SetUp();
  }
};

// INSTANTIATE_TEST_SUITE_P(Devices, Suite, network_devices, network_device_name)
inline auto const network_devices = ::testing::Values("emulated", "cuda");
inline std::string network_device_name(::testing::TestParamInfo<char const*> const& info) { return info.param; }

}  // namespace scree::testing
