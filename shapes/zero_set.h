// zero_set.h: the surface phi = 0 as a closed triangle mesh, and the mass properties of the solid phi > 0.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/phi_batch.h"
#include "shapes/triangle_mesh.h"

namespace scree {

struct ZeroSetOptions {
  double radius = 0;     // the mesh is sought in this ball about the origin; beyond it everything counts as outside [d]
  int cells = 48;        // grid cells across the ball's diameter; about 10 triangles a surface cell
  double lipschitz = 0;  // bound of |grad phi| that lets far cells be skipped; <= 0: every grid point is evaluated
};

struct ZeroSet {
  TriangleMesh mesh;             // closed, counter-clockwise seen from outside, vertices on phi = 0
  std::vector<Vec3> normal;      // outward unit normal -grad phi / |grad phi| at each vertex
  std::vector<int> corner;       // vertices on sharp corners; empty until sharpen_corners (support_points.h)
  double cell = 0;               // edge of a grid cell [d]
  double worst_phi = 0;          // largest |phi| left at a vertex [d]
  int components = 0;            // connected pieces of the surface; a void inside counts too
  int euler_characteristic = 0;  // V - E + F, 2 for a body without handles, voids and splinters
};

// Marching tetrahedra on a cubic grid (six tetrahedra a cell, so the mesh is a closed manifold for any phi), then the
// vertices are moved along the gradient onto phi = 0. Detail below the cell size may be missed. Deterministic.
// Throws std::runtime_error when the ball holds no surface, std::invalid_argument for a bad option.
ZeroSet find_zero_set(PhiBatch const& phi, ZeroSetOptions const& options);

// Mass properties of the solid inside the zero set: those of its first two refinements, extrapolated: error O(cell^4)
// on smooth surfaces, O(cell^3) at sharp corners.
MeshMass zero_set_mass(PhiBatch const& phi, ZeroSet const& zero_set);

// Each triangle cut in four, new vertices projected onto phi = 0; on sharp edges they land on the edge.
ZeroSet refine(PhiBatch const& phi, ZeroSet const& coarse);

}  // namespace scree
