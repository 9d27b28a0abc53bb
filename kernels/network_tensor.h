// network_tensor.h: launches of the tensor core kernel, which is compiled apart. For .cu files only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/base/cuda_buffer.h"
#include "kernels/network_device.h"
#include "kernels/sdf/tensor_image.h"

namespace scree::sdf_fused {

// A TensorClass in device memory.
struct TensorsOnDevice {
  CudaBuffer<TensorRecord> net;
  CudaBuffer<Half2> word;
  CudaBuffer<float> number;

  void upload(TensorClass const& from, cudaStream_t stream) {
    net.upload(from.net, stream);
    word.upload(from.word, stream);
    number.upload(from.number, stream);
  }
  Tensors view(float const* bias) const { return {net.span(), word.data(), number.data(), bias}; }
};

// All tiles of a class; `precision`: fp16x3 or fast. Throws DeviceError, also for a GPU before compute capability 8.0.
void launch_tensor_tiles(CudaDevice const& device, cudaStream_t stream, NetworkClass const& of, Tensors const& tensors,
                         Precision precision, Queries const& queries, Span<const Tile> tiles);

}  // namespace scree::sdf_fused
