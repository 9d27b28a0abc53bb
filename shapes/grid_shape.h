// grid_shape.h: bounds of a shape whose phi is trilinear on a grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/shape.h"

namespace scree {

// Fill in kind, box, bounding radius and Lipschitz bound of a shape that is the grid `index` of the library. The box is
// exact: between two layers the interpolant is largest on a grid line. The radius exceeds the farthest point by at most
// a fifth of a cell. The Lipschitz bound is proven for all cells that are not wholly inside the solid: each component
// of the gradient is a mean of four differences along grid lines.
void set_grid(Library const& library, int index, Shape& shape);

}  // namespace scree
