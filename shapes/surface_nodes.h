// surface_nodes.h: the points that carry contact: on corners, along edges, elsewhere by curvature, with areas.
// shapes.md of the design gives the rule: a node spacing s leaves a blind gap s^2 / (4 R_local).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/node_storage.h"
#include "shapes/phi_batch.h"

namespace scree {

// Nodes of one shape, units of d, body frame, sorted so that consecutive runs of nodes_per_block are compact.
// The first n_surface nodes lie on the surface; the rest are core nodes (every 4th surface node at half scale with
// 4x its area, and the centre with the total area; those that are inside) that keep the contact energy monotone in deep
// overlap.
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

struct SurfaceNodeOptions {
  bool measure_gap = true;  // fill in largest_gap; costs about a tenth of the whole
};

// Nodes of a normalised shape (uses its bounding radius, volume, area and Lipschitz bound). `phi` as from surface_phi.
// n_surface is `count`, or a few less. Areas are the projected ones, |integral of n dA| over the node's cell, with the
// cell's mean normal: on an edge a node has the bisecting normal, sum A n = 0 and sum A x.n = 3 V hold to rounding, and
// the flat faces keep their areas. Deterministic and serial: call it for many shapes in parallel.
// Throws std::runtime_error without a zero set, std::invalid_argument for count < 4.
SurfaceNodes make_surface_nodes(PhiBatch const& phi, Shape const& shape, int count,
                                SurfaceNodeOptions const& options = {});
SurfaceNodes make_surface_nodes(Library const& library, Shape const& shape, int count,
                                SurfaceNodeOptions const& options = {});

// Largest blind gap of the surface nodes against a plane [d]: how much higher the surface reaches than its nodes, over
// `directions` quasi-uniform directions. `dense`: points on phi = 0 about 2 `step` apart, refined by climbing.
double largest_gap(PhiBatch const& phi, std::vector<Vec3> const& dense, double step, SurfaceNodes const& nodes,
                   int directions = 1000);

// At least `count` points of the surface, independent of any nodes, on edges and at the extreme points of 2,000
// directions too (those carry no area): what overlap meters and certificates use.
struct DenseSurface {
  std::vector<Vec3> position;
  std::vector<Vec3> normal;  // outward unit
  std::vector<double> area;  // [d^2]
};
DenseSurface make_dense_surface(PhiBatch const& phi, Shape const& shape, int count);

}  // namespace scree
