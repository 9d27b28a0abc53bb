// direction_set.h: nearly uniform unit directions with their cells and neighbours, shared by all compact grains of one
// node count.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/vec.h"

namespace scree {

// Sorted so that runs of nodes_per_block are compact, and every core_every-th direction covers the sphere evenly.
struct DirectionSet {
  std::vector<Vec3> direction;      // unit (n)
  std::vector<double> solid_angle;  // of the Voronoi cells, 4 pi in all (n)
  std::vector<int> ring_first;      // of a direction's neighbours in the triangulation (n + 1)
  std::vector<int> neighbour;       // counter-clockwise seen from outside
  std::vector<Vec3> block_axis;     // mean direction of the surface blocks, then of the core blocks
  int surface_blocks = 0, core_blocks = 0;

  int count() const { return static_cast<int>(direction.size()); }
};

// Spherical centroidal Voronoi tessellation: a Fibonacci lattice and a few rounds of Lloyd's iteration on the convex
// hull, which is the Delaunay triangulation on the sphere (Brown 1979). Deterministic, O(count^2): 0.1 s for 1,000,
// a second for 4,000. Throws std::invalid_argument outside 16 <= count <= 20,000.
DirectionSet make_direction_set(int count);

}  // namespace scree
