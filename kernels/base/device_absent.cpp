// device_absent.cpp: device.h in a build without CUDA.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/device.h"

namespace scree {

CudaDevice cuda_device() {
  throw DeviceError("this build has no CUDA backend: configure with SCREE_CUDA=ON where nvcc is installed");
}

std::string describe(CudaDevice const& device) { return device.name; }

}  // namespace scree
