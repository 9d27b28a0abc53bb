// pool.cpp: all samples of all bodies as LibTorch tensors, cut into blocks.
// SPDX-License-Identifier: Apache-2.0
#include "training/pool.h"

#include <algorithm>
#include <stdexcept>

namespace scree {

std::vector<SampleBlock> make_blocks(std::vector<Samples> const& by_body, int rows, torch::Device const& device) {
  if (by_body.empty()) throw std::invalid_argument("make_blocks: no bodies");
  std::size_t count = by_body.front().point.size();
  for (Samples const& samples : by_body) count = std::min(count, samples.point.size());
  if (count == 0) throw std::invalid_argument("make_blocks: a body has no samples");
  std::int64_t const shapes = static_cast<std::int64_t>(by_body.size());
  std::size_t const taken = std::clamp<std::size_t>(rows, 1, count);
  std::vector<SampleBlock> blocks(count / taken);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    SampleBlock& block = blocks[b];
    block.point = torch::empty({shapes, static_cast<std::int64_t>(taken), 3}, torch::kFloat32);
    block.phi = torch::empty({shapes, static_cast<std::int64_t>(taken)}, torch::kFloat32);
    block.gradient = torch::empty_like(block.point);
    float* point = block.point.data_ptr<float>();
    float* phi = block.phi.data_ptr<float>();
    float* gradient = block.gradient.data_ptr<float>();
    for (Samples const& samples : by_body)
      for (std::size_t i = b * taken; i < (b + 1) * taken; ++i) {
        *phi++ = static_cast<float>(samples.phi[i]);
        for (int k = 0; k < 3; ++k) {
          *point++ = static_cast<float>(samples.point[i][k]);
          *gradient++ = static_cast<float>(samples.gradient[i][k]);
        }
      }
    block = {block.point.to(device), block.phi.to(device), block.gradient.to(device)};
  }
  return blocks;
}

}  // namespace scree
