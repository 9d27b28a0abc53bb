// bake.h: the same grain with another evaluator: phi of any shape on a grid, or its zero set as a mesh.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/shape.h"

namespace scree {

int constexpr default_grid_cells = 43;  // across the bounding diameter: the level-set grid of the reference paper
int constexpr default_mesh_cells =
    16;  // ... of the grid that is marched before one refinement: 10,000 to 25,000 triangles

// Both give a library with one shape: name, mass and certificate of `source`, another phi with its own box, bounding
// radius and Lipschitz bound. The mass stays that of the source: baking changes how a grain is asked, not what it is.
// Deterministic for any number of threads. std::runtime_error when there is no zero set.

// phi at the points of a cubic grid over the box of the shape and a cell beyond, as float. The trilinear zero set lies
// within about cell^2 / (4 R_local) of the source's; sharp edges are rounded at the size of a cell.
Library bake_grid(Library const& library, Shape const& source, int cells, int threads = 1);

// The zero set triangulated: find_zero_set, refined once, corners and edges recovered. Where that folds the surface
// over, which the sign of points around every vertex shows, grids of up to five cells more are tried; here and there an
// edge is cut by up to half a cell. A source that is a mesh already is triangulated anew.
Library bake_mesh(Library const& library, Shape const& source, int cells, int threads = 1);

}  // namespace scree
