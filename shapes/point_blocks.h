// point_blocks.h: points in compact blocks with bounding spheres.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/vec.h"

namespace scree {

struct PointBlocks {
  std::vector<int> order;      // order[i]: index of the point at place i
  std::vector<int> first;      // places of block b: [first[b], first[b + 1])
  std::vector<Vec3> centre;    // of a small enclosing sphere
  std::vector<double> radius;  // encloses the block's points, rounding included
};

// Halve the longest side until `size` points are left; all blocks but the last are full. Deterministic.
PointBlocks make_point_blocks(std::vector<Vec3> const& point, int size);

}  // namespace scree
