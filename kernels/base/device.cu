// device.cu: devices and errors through the CUDA runtime.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/device.h"

#include <cuda_runtime.h>

#include "kernels/base/cuda_buffer.h"

namespace scree {
namespace {

char const* way_out(cudaError_t status) {
  switch (status) {
    case cudaErrorInsufficientDriver:
      return "; no driver, or one older than this build's CUDA: install a newer NVIDIA driver, or run with --device "
             "cpu";
    case cudaErrorNoDevice:
      return "; the driver sees no GPU (is CUDA_VISIBLE_DEVICES empty?): run with --device cpu";
    case cudaErrorMemoryAllocation:
      return "; too little device memory: fewer grains or nodes, or a GPU that nobody else uses";
    case cudaErrorNoKernelImageForDevice:
    case cudaErrorInvalidDeviceFunction:
      return "; configure with SCREE_CUDA_ARCHITECTURES set to this device's compute capability";
    case cudaErrorDevicesUnavailable:
      return "; the device is in use by another process or in prohibited mode";
    case cudaErrorECCUncorrectable:
    case cudaErrorLaunchFailure:
    case cudaErrorIllegalAddress:
      return "; the device is lost to this process: restart from the last checkpoint";
    default:
      return "";
  }
}

}  // namespace

void check_cuda(cudaError_t status, std::string const& what) {
  if (status == cudaSuccess) return;
  cudaGetLastError();  // clears what is not sticky
  throw DeviceError("CUDA: " + what + ": " + cudaGetErrorString(status) + way_out(status));
}

CudaDevice cuda_device() {
  int device = 0, count = 0;
  CudaDevice out;
  check_cuda(cudaGetDeviceCount(&count), "looking for a device");
  check_cuda(count == 0 ? cudaErrorNoDevice : cudaSuccess, "looking for a device");
  check_cuda(cudaGetDevice(&device), "choosing a device");
  cudaDeviceProp properties{};
  check_cuda(cudaGetDeviceProperties(&properties, device), "reading the device's properties");
  check_cuda(cudaMemGetInfo(&out.free, &out.memory), "reading the device's memory");
  check_cuda(cudaDriverGetVersion(&out.driver), "reading the driver's version");
  check_cuda(cudaRuntimeGetVersion(&out.runtime), "reading the runtime's version");
  out.name = properties.name;
  out.major = properties.major, out.minor = properties.minor;
  out.multiprocessors = properties.multiProcessorCount;
  out.shared_memory = properties.sharedMemPerBlockOptin;
  return out;
}

std::string describe(CudaDevice const& d) {
  auto const version = [](int v) { return std::to_string(v / 1000) + "." + std::to_string(v % 1000 / 10); };
  return d.name + ", compute capability " + std::to_string(d.major) + "." + std::to_string(d.minor) + ", " +
         std::to_string(d.free >> 20) + " of " + std::to_string(d.memory >> 20) + " MiB free, CUDA " +
         version(d.runtime) + ", driver for CUDA " + version(d.driver);
}

}  // namespace scree
