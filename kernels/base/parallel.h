// parallel.h: the one loop of the engine.
// parallel_for runs a named functor over 0..n-1 on the queue's backend: OpenMP on the CPU, one checked generic kernel
// on the GPU. Functors, never lambdas: nvcc's host-device lambdas run 13-17x slower on the host.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "kernels/base/config.h"
#include "kernels/base/profile.h"
#include "kernels/base/queue.h"

#if defined(__CUDACC__)
#include <cuda_runtime.h>
#endif

namespace scree {

#if defined(__CUDACC__)
namespace detail {
template <class Functor>
__global__ void generic_kernel(int n, Functor functor) {
  int const i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < n) functor(i);
}
}  // namespace detail
#endif

// Run functor(i) for every i in [0, n). Order is unspecified, so functor(i) must write only what belongs to i.
// `grain`: items a CPU thread takes at a time. n <= 0 launches nothing. Blocks on the CPU; asynchronous on a GPU.
template <class Functor>
void parallel_for(Queue const& queue, char const* name, int n, Functor const& functor, int grain = 64) {
  if (n <= 0) return;
  ScopedTimer const timer(queue.profile, name, n);
  if (queue.backend == Backend::cpu) {
    // A team costs microseconds; a loop of one grain does not repay it.
    if (queue.threads <= 1 || n <= grain) {
      for (int i = 0; i < n; ++i) functor(i);
      return;
    }
#pragma omp parallel for schedule(dynamic, grain) num_threads(queue.threads)
    for (int i = 0; i < n; ++i) functor(i);
    return;
  }
#if defined(__CUDACC__)
  int constexpr threads = 256;  // a multiple of every warp size, enough blocks an SM at <= 64 registers
  detail::generic_kernel<<<(n + threads - 1) / threads, threads, 0, static_cast<cudaStream_t>(queue.stream)>>>(n,
                                                                                                               functor);
  cudaError_t const status = cudaGetLastError();
  if (status != cudaSuccess)
    throw std::runtime_error(std::string(name) + ": launch failed: " + cudaGetErrorString(status));
#else
  throw std::runtime_error(std::string(name) + ": this build has no CUDA backend");
#endif
}

}  // namespace scree
