// surface_nodes.h: the points that carry contact: on corners, along edges, elsewhere by curvature, with areas.
// shapes.md of the design gives the rule: a node spacing s leaves a blind gap s^2 / (4 R_local).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/vec.h"

namespace scree {

int constexpr nodes_per_block = 32;  // one network query decides over a block; 32 = 11-12 % of nodes survive it

// Nodes of one shape, units of d, body frame, sorted so that consecutive runs of nodes_per_block are compact.
// The first n_surface nodes lie on the surface; the rest are core nodes (every 4th surface node at half scale with
// 4x its area, and the centre with the total area) that keep the contact energy monotone in deep overlap.
struct SurfaceNodes {
  std::vector<Vec3> position;
  std::vector<double> area;  // [d^2]
  std::vector<Vec3> normal;  // outward unit; zero for core nodes
  int n_surface = 0;
  std::vector<Vec3> block_centre;    // of nodes [32 b, 32 b + 32); core nodes have blocks of their own
  std::vector<double> block_radius;  // [d]
  std::vector<int> block_first;      // first node of block b; size n_blocks + 1
  double largest_gap = -1;           // to a plane over 1,000 directions [d]; -1: not measured
  double spacing = 0;                // typical: sqrt(area / n_surface) [d]
};

}  // namespace scree
