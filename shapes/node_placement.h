// node_placement.h: where surface nodes sit and what they stand for: a centroidal Voronoi tessellation of a fine mesh
// of phi = 0, dense where the surface bends, with nodes on ridges and corners.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/zero_set.h"

namespace scree {

struct PlacementOptions {
  int count = 4000;
  // Node density (per area) is proportional to the largest convex curvature within these bounds [1/d]. The lower one is
  // the sphere's own; the upper one makes the spacing on edges a third of that on flat faces.
  double least_curvature = 2;
  double largest_curvature = 18;
  double ridge_spacing = 0.02;  // largest mean spacing of nodes along sharp edges [d]
  int rounds = 7;               // of Lloyd's iteration
  int directions = 3000;        // in which the nodes' support is compared with the mesh's
  double gap_tolerance = 1e-3;  // support deficit at which a node moves to the extreme point [d]
};

struct PlacedNodes {
  std::vector<Vec3> position;     // on phi = 0
  std::vector<Vec3> area_vector;  // integral of the outward unit normal over the node's cell [d^2]; their sum is zero
};

// `fine` should have at least a dozen triangles a node. Deterministic, serial. May return a few nodes less than asked
// for (cells that came out empty). Throws std::invalid_argument for count < 4.
PlacedNodes place_nodes(PhiBatch const& phi, ZeroSet const& fine, PlacementOptions const& options);

}  // namespace scree
