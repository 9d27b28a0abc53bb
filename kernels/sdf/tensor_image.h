// tensor_image.h: the networks of a NetworkImage as tensor cores take them, still on the host: scaled, split, packed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/sdf/network_image.h"
#include "kernels/sdf/tensor_tile.h"

namespace scree::sdf_fused {

// Beside NetworkImage::classes, whose bias rows it shares.
struct TensorClass {
  std::vector<TensorRecord> net;
  std::vector<Half2> word;
  std::vector<float> number;

  Tensors view(NetworkClass const& of) const { return {net, word.data(), number.data(), of.bias.data()}; }
};

// Scales and filter_bound come from `samples` points in the balls of a network's shapes, evaluated here in fp32 and
// with fp16's roundings: about 5 us each. Throws std::invalid_argument naming the network when its activations come
// near the end of half precision's range.
std::vector<TensorClass> make_tensor_image(SceneView const& scene, NetworkImage const& image);

int constexpr tensor_samples = 1024;  // a network at least; one a shape at least
// filter_bound over the largest error of fp16 at the samples. Errors are sums of many roundings: over 1e5 points of
// random and shipped networks the largest is below twice that of the samples (network_device_test).
float constexpr filter_margin = 5;

}  // namespace scree::sdf_fused
