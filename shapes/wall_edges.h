// wall_edges.h: points along the sharp edges of a wall, where a grain may rest between its own nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree {

struct WallEdge {
  Vec3 from, to;
  Vec3 outward;         // unit, between the normals of its faces; of a border: away from the surface, in it
  bool border = false;  // edge of one triangle
};

// Edges at which the solid behind the triangles (see MeshBorder::open) is convex and turns by more than `angle` [rad].
// both_sides: it is solid on neither side (a sheet), so that every sharp fold and every border counts. Edges of three
// and more triangles count as sharp. In the order of the mesh.
std::vector<WallEdge> sharp_wall_edges(TriangleMesh const& mesh, double angle, bool both_sides);

// Points no further than `spacing` apart along the edges, each standing for `length` of its edge [unit].
struct EdgePoints {
  std::vector<Vec3> position, outward;
  std::vector<double> length;
};
EdgePoints points_along(std::vector<WallEdge> const& edges, double spacing);

}  // namespace scree
