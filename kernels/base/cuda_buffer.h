// cuda_buffer.h: device memory that grows, and the check of every CUDA call. For .cu files only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime.h>

#include <string>
#include <utility>
#include <vector>

#include "kernels/base/device.h"
#include "kernels/base/span.h"

namespace scree {

// Throws DeviceError with what was tried and CUDA's own words; names the way out where there is one.
void check_cuda(cudaError_t status, std::string const& what);

// Device array. Contents are lost when it grows. Not copied; moved freely.
template <class T>
class CudaBuffer {
 public:
  CudaBuffer() = default;
  ~CudaBuffer() { cudaFree(data_); }
  CudaBuffer(CudaBuffer&& other) noexcept { *this = std::move(other); }
  CudaBuffer& operator=(CudaBuffer&& other) noexcept {
    std::swap(data_, other.data_), std::swap(size_, other.size_), std::swap(capacity_, other.capacity_);
    return *this;
  }

  // At least n items; a quarter more than asked, so that a slowly growing batch does not reallocate each step.
  void resize(int n) {
    size_ = n;
    if (static_cast<std::size_t>(n) <= capacity_) return;
    cudaFree(std::exchange(data_, nullptr));
    capacity_ = 0;
    std::size_t const wanted = static_cast<std::size_t>(n) + n / 4;
    check_cuda(cudaMalloc(reinterpret_cast<void**>(&data_), wanted * sizeof(T)),
               "allocating " + std::to_string(wanted * sizeof(T)) + " bytes of device memory");
    capacity_ = wanted;
  }
  void upload(Span<const T> from, cudaStream_t stream) {
    resize(from.size());
    if (!from.empty())
      check_cuda(cudaMemcpyAsync(data_, from.data, from.size() * sizeof(T), cudaMemcpyHostToDevice, stream),
                 "copying to the device");
  }
  void upload(std::vector<T> const& from, cudaStream_t stream) { upload(Span<const T>(from), stream); }
  void download(Span<T> to, cudaStream_t stream) const {
    if (!to.empty())
      check_cuda(cudaMemcpyAsync(to.data, data_, to.size() * sizeof(T), cudaMemcpyDeviceToHost, stream),
                 "copying from the device");
  }

  int size() const { return size_; }
  T const* data() const { return data_; }
  Span<const T> span() const { return {data_, size_}; }
  Span<T> mutable_span() { return {data_, size_}; }

 private:
  T* data_ = nullptr;
  int size_ = 0;
  std::size_t capacity_ = 0;
};

}  // namespace scree
