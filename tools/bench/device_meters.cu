// device_meters.cu: see device_meters.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/device_meters.h"

#include <algorithm>
#include <vector>

#include "kernels/base/cuda_buffer.h"

namespace scree::bench {
namespace {

int constexpr threads = 256, chains = 8, trips = 4096;

__global__ void multiply_add(float seed, float* out) {
  float a[chains];
  for (int k = 0; k < chains; ++k) a[k] = seed + static_cast<float>(k + threadIdx.x);
  for (int i = 0; i < trips; ++i)
#pragma unroll
    for (int k = 0; k < chains; ++k) a[k] = fmaf(a[k], 0.999f, seed);
  float sum = 0;
  for (int k = 0; k < chains; ++k) sum += a[k];
  if (sum == 12345.678f) out[0] = sum;  // never; but the compiler cannot know
}

__global__ void look_up(GridFrame frame, Span<const float> value, Span<const Vec3> point, Span<const int> which,
                        Span<double> phi) {
  int const i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  if (i >= point.size()) return;
  std::size_t const size = frame.points();
  Span<const float> const own(value.data + which[i] * size, static_cast<int>(size));
  phi[i] = grid_distance(frame, own, point[i], nullptr);
}

template <class Launch>
double median_seconds(int rounds, Launch const& launch) {
  cudaEvent_t before, after;
  check_cuda(cudaEventCreate(&before), "making an event");
  check_cuda(cudaEventCreate(&after), "making an event");
  std::vector<float> milliseconds(rounds);
  launch();  // warm
  for (float& t : milliseconds) {
    check_cuda(cudaEventRecord(before), "timing");
    launch();
    check_cuda(cudaGetLastError(), "launch");
    check_cuda(cudaEventRecord(after), "timing");
    check_cuda(cudaEventSynchronize(after), "timing");
    check_cuda(cudaEventElapsedTime(&t, before, after), "timing");
  }
  cudaEventDestroy(before);
  cudaEventDestroy(after);
  std::nth_element(milliseconds.begin(), milliseconds.begin() + rounds / 2, milliseconds.end());
  return 1e-3 * milliseconds[rounds / 2];
}

}  // namespace

double measure_device_peak() {
  CudaBuffer<float> out;
  out.resize(1);
  int const blocks = cuda_device().multiprocessors * 16;
  double const flop = 2.0 * chains * trips * threads * blocks;
  float* const data = out.mutable_span().data;
  return flop / median_seconds(5, [&] { multiply_add<<<blocks, threads>>>(0.001f, data); });
}

double time_grid_lookups(GridFrame const& frame, Span<const float> value, Span<const Vec3> point, Span<const int> which,
                         int rounds, Span<double> phi) {
  CudaBuffer<float> values;
  CudaBuffer<Vec3> points;
  CudaBuffer<int> indices;
  CudaBuffer<double> results;
  values.upload(value, nullptr);
  points.upload(point, nullptr);
  indices.upload(which, nullptr);
  results.resize(point.size());
  int const blocks = (point.size() + threads - 1) / threads;
  double const seconds = median_seconds(rounds, [&] {
    look_up<<<blocks, threads>>>(frame, values.span(), points.span(), indices.span(), results.mutable_span());
  });
  results.download(phi, nullptr);
  check_cuda(cudaDeviceSynchronize(), "reading results");
  return seconds;
}

}  // namespace scree::bench
