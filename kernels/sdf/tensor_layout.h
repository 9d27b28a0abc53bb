// tensor_layout.h: how the networks of a class lie in memory for tensor cores.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sdf/tensor_warp.h"

namespace scree::sdf_fused {

// One network of a class for tensor cores. Weights and activations are scaled by powers of two, exactly, so that the
// largest fill the range of half precision and low parts keep their bits (half.h).
//   fragments, in words: for each layer 1 ... hidden - 1 on the way forward, then for each on the way back: high parts,
//     low parts (W W / 2 each), in the order of fragment_word
//   numbers: first forward (3 x W) | biases of layers 1 ... hidden - 1 (W each) | last forward (W) | last backward (W),
//     then first backward (3 x W: [coordinate][neuron])
struct TensorRecord {
  std::size_t first_word = 0, first_number = 0;
  std::size_t first_bias = 0;  // float, of Networks::bias
  int hidden = 0;
  float last_bias = 0, slope = 0;
  float first_scale = 1;             // of what layer 0 puts out
  float down[max_hidden] = {};       // takes the scales of layer l's product off, forward
  float back_down[max_hidden] = {};  // the same on the way from layer l to l - 1
  float filter_bound = 0;            // fp16's phi is nearer to fp32's than this [network's unit]
};

// Words of one plane (high or low) of a layer's fragments: k x n weights, neuron n in column n of B. Blocks of 8 inputs
// come in pairs (m16n8k16), an odd last one alone (m16n8k8). Position of block `k` of output block `n`, lane 0; lanes
// are `fragment_step` words apart.
SCREE_HD constexpr int plane_words(int w) { return w * w / 2; }
SCREE_HD constexpr bool in_pair(int blocks, int k) { return k < blocks - blocks % 2; }
SCREE_HD constexpr int fragment_word(int blocks, int n, int k) {
  return (n * blocks + k - (in_pair(blocks, k) ? k % 2 : 0)) * warp_lanes + (in_pair(blocks, k) ? k % 2 : 0);
}
SCREE_HD constexpr int fragment_step(int blocks, int k) { return in_pair(blocks, k) ? 2 : 1; }

struct Tensors {
  Span<const TensorRecord> net;
  Half2 const* word = nullptr;    // 8-byte aligned
  float const* number = nullptr;  // 8-byte aligned
  float const* bias = nullptr;    // rows of W, those of Networks
};

}  // namespace scree::sdf_fused
