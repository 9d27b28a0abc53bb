// point_blocks.cpp: see point_blocks.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/point_blocks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scree {
namespace {

int longest_side(std::vector<Vec3> const& point, int const* begin, int const* end) {
  Vec3 low = point[*begin], high = low;
  for (int const* i = begin; i != end; ++i)
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], point[*i][k]);
      high[k] = std::max(high[k], point[*i][k]);
    }
  Vec3 const side = high - low;
  return side.x >= side.y ? (side.x >= side.z ? 0 : 2) : (side.y >= side.z ? 1 : 2);
}

void halve(std::vector<Vec3> const& point, int* begin, int* end, int size) {
  int const n = static_cast<int>(end - begin);
  if (n <= size) return;
  // The left part takes a whole number of blocks, so that only the very last block can be short.
  int const blocks = (n + size - 1) / size, left = (blocks + 1) / 2 * size;
  int const axis = longest_side(point, begin, end);
  auto const before = [&](int a, int b) {
    return point[a][axis] != point[b][axis] ? point[a][axis] < point[b][axis] : a < b;
  };
  std::nth_element(begin, begin + left, end, before);
  halve(point, begin, begin + left, size);
  halve(point, begin + left, end, size);
}

// Badoiu and Clarkson (2003): walk towards the farthest point in steps of 1/(k+1); within 2 % of the smallest sphere.
void enclose(std::vector<Vec3> const& point, int const* begin, int const* end, Vec3& centre, double& radius) {
  centre = {};
  for (int const* i = begin; i != end; ++i) centre += point[*i] / static_cast<double>(end - begin);
  auto const farthest = [&](double& distance2) {
    int best = *begin;
    distance2 = -1;
    for (int const* i = begin; i != end; ++i) {
      double const d2 = norm2(point[*i] - centre);
      if (d2 > distance2) distance2 = d2, best = *i;
    }
    return best;
  };
  double distance2 = 0;
  for (int k = 1; k <= 30; ++k) centre += (point[farthest(distance2)] - centre) / (k + 1.0);
  farthest(distance2);
  radius = std::sqrt(distance2) * (1 + 1e-12);
}

}  // namespace

PointBlocks make_point_blocks(std::vector<Vec3> const& point, int size) {
  PointBlocks blocks;
  int const n = static_cast<int>(point.size());
  blocks.order.resize(n);
  std::iota(blocks.order.begin(), blocks.order.end(), 0);
  halve(point, blocks.order.data(), blocks.order.data() + n, size);
  for (int begin = 0; begin < n; begin += size) {
    blocks.first.push_back(begin);
    blocks.centre.emplace_back();
    blocks.radius.emplace_back();
    enclose(point, blocks.order.data() + begin, blocks.order.data() + std::min(begin + size, n), blocks.centre.back(),
            blocks.radius.back());
  }
  blocks.first.push_back(n);
  return blocks;
}

}  // namespace scree
