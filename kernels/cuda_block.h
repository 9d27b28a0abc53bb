// cuda_block.h: a CUDA thread block as mlp_fused.h asks for it, and launches of one block a tile. For .cu files only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include <algorithm>
#include <string>

#include "kernels/base/cuda_buffer.h"
#include "kernels/base/device.h"
#include "kernels/sdf/mlp_fused.h"

namespace scree::sdf_fused {

// The lanes of a CUDA thread block. Bodies are empty in the host pass, which never runs them.
struct ThreadBlock {
  template <class Step>
  SCREE_HD void each(Step const& step) const {
#if defined(__CUDA_ARCH__)
    step(static_cast<int>(threadIdx.x));
#endif
  }
  SCREE_HD void sync() const {
#if defined(__CUDA_ARCH__)
    __syncthreads();
#endif
  }
  // In the order of Lanes::compact: masks of 32 positions, then each lane's place among them.
  template <class Flag>
  SCREE_HD int compact(Flag const& flag, int* list, int* masks) const {
    int total = 0;
#if defined(__CUDA_ARCH__)
    int const lane = static_cast<int>(threadIdx.x);
    bool wanted[points_a_lane];
    __syncthreads();  // phi of all lanes is written
    for (int p = 0; p < points_a_lane; ++p) {
      int const i = p * lanes + lane;
      wanted[p] = flag(i);
      unsigned const mask = __ballot_sync(0xffffffffu, wanted[p]);
      if (lane % 32 == 0) masks[i / 32] = static_cast<int>(mask);
    }
    __syncthreads();
    int before[points_a_lane] = {};
    for (int word = 0; word < tile_points / 32; ++word) {
      for (int p = 0; p < points_a_lane; ++p)
        if ((p * lanes + lane) / 32 == word) before[p] = total;
      total += __popc(static_cast<unsigned>(masks[word]));
    }
    for (int p = 0; p < points_a_lane; ++p) {
      int const i = p * lanes + lane;
      unsigned const lower = static_cast<unsigned>(masks[i / 32]) & ((1u << (lane % 32)) - 1u);
      if (wanted[p]) list[before[p] + __popc(lower)] = i;
    }
    __syncthreads();
#endif
    return total;
  }
};

// A kernel with `bytes` of shared memory a block, for so many tiles: as many blocks as the device holds at once.
template <class Kernel, class... Arguments>
void launch_tiles(char const* what, CudaDevice const& device, cudaStream_t stream, Kernel kernel, std::size_t bytes,
                  int tiles, Arguments const&... arguments) {
  if (bytes > device.shared_memory)
    throw DeviceError("the network kernel needs " + std::to_string(bytes) + " bytes of shared memory a block; " +
                      device.name + " has " + std::to_string(device.shared_memory));
  check_cuda(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(bytes)),
             std::string(what) + ": this build holds no code for the device's chip");
  int blocks = 0;
  check_cuda(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, lanes, bytes), "occupancy");
  int const grid = std::min(tiles, std::max(1, blocks) * device.multiprocessors);
  kernel<<<grid, lanes, bytes, stream>>>(arguments...);
  check_cuda(cudaGetLastError(), std::string(what) + ": launch");
}

}  // namespace scree::sdf_fused
