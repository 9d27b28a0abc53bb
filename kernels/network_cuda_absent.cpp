// network_cuda_absent.cpp: network_device.h in a build without CUDA.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/device.h"
#include "kernels/network_device.h"

namespace scree {

std::unique_ptr<NetworkDevice> make_cuda_network_device() {
  cuda_device();  // throws: there is none in this build
  return nullptr;
}

}  // namespace scree
