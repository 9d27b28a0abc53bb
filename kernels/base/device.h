// device.h: the CUDA devices of this machine, and errors that name them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace scree {

// The device asked for is not there, is too small, was built for another chip or was lost; the message says which and
// what to do.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct CudaDevice {
  std::string name;          // "NVIDIA H200"
  int major = 0, minor = 0;  // compute capability
  int multiprocessors = 0;
  std::size_t memory = 0, free = 0;  // [bytes]
  std::size_t shared_memory = 0;     // a block may ask for [bytes]
  int driver = 0, runtime = 0;       // CUDA versions, 1000 major + 10 minor
};

// The current CUDA device. Throws DeviceError: this build has no CUDA, no driver, no device.
CudaDevice cuda_device();

// One line for logs: name, compute capability, memory, driver.
std::string describe(CudaDevice const& device);

}  // namespace scree
