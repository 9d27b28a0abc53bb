// pool.h: all samples of all bodies as LibTorch tensors, cut into blocks that a work unit takes whole.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <torch/types.h>

#include <vector>

#include "training/dataset.h"

namespace scree {

struct SampleBlock {
  torch::Tensor point;     // (shapes, rows, 3) [d]
  torch::Tensor phi;       // (shapes, rows) [d]
  torch::Tensor gradient;  // (shapes, rows, 3)
};

// `rows` samples of every body a block; a rest that fills no block is left out, but there is at least one block (with
// fewer rows where the pool is that small).
std::vector<SampleBlock> make_blocks(std::vector<Samples> const& by_body, int rows,
                                     torch::Device const& device = torch::kCPU);

}  // namespace scree
