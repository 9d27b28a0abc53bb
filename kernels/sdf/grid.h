// grid.h: signed distance from values on a grid, trilinear, with the exact gradient of the interpolant.
// The gradient is that of the very field that is evaluated, so contact energy is conserved. phi > 0 inside.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "kernels/base/span.h"
#include "kernels/base/vec.h"

namespace scree {

// Cubic cells; grid point (i, j, k) lies at origin + cell (i, j, k), its value at index (k ny + j) nx + i. Values are
// float: their rounding, 6e-8 of phi, is far below what the interpolation leaves (about cell^2 / 4 R).
struct GridFrame {
  Vec3 origin;
  double cell = 0;
  int nx = 0, ny = 0, nz = 0;  // points, at least 2 each

  SCREE_HD std::size_t points() const { return std::size_t(nx) * ny * nz; }
};

// phi and, unless null, its gradient at x, in the unit of the grid. Outside the box of the grid phi continues as
// -sqrt(phi_b^2 + D^2), with phi_b at the nearest point of the box and D the distance to it: continuous, and no steeper
// than the interpolant. For that the values on the box's faces must not be positive.
// On a face between two cells the gradient is that of the upper cell.
SCREE_HD inline double grid_distance(GridFrame const& grid, Span<const float> value, Vec3 x, Vec3* gradient) {
  int const size[3] = {grid.nx, grid.ny, grid.nz};
  int at[3];
  double t[3];  // position in the cell, 0..1
  Vec3 out;     // from the box to x
  for (int i = 0; i < 3; ++i) {
    double s = (x[i] - grid.origin[i]) / grid.cell;
    double const last = size[i] - 1;
    if (!(s > 0)) out[i] = s * grid.cell, s = 0;
    if (s > last) out[i] = (s - last) * grid.cell, s = last;
    at[i] = static_cast<int>(s);
    if (at[i] > size[i] - 2) at[i] = size[i] - 2;
    t[i] = s - at[i];
  }
  std::size_t const row = grid.nx, layer = row * grid.ny;
  float const* const v = value.data + at[2] * layer + at[1] * row + at[0];
  double const v000 = v[0], v100 = v[1], v010 = v[row], v110 = v[row + 1];
  double const v001 = v[layer], v101 = v[layer + 1], v011 = v[layer + row], v111 = v[layer + row + 1];
  // Along x, then y, then z.
  double const x00 = v000 + t[0] * (v100 - v000), x10 = v010 + t[0] * (v110 - v010);
  double const x01 = v001 + t[0] * (v101 - v001), x11 = v011 + t[0] * (v111 - v011);
  double const y0 = x00 + t[1] * (x10 - x00), y1 = x01 + t[1] * (x11 - x01);
  double const inside = y0 + t[2] * (y1 - y0);
  if (gradient) {
    double const d00 = v100 - v000, d10 = v110 - v010, d01 = v101 - v001, d11 = v111 - v011;
    double const dx0 = d00 + t[1] * (d10 - d00), dx1 = d01 + t[1] * (d11 - d01);
    double const dy0 = x10 - x00, dy1 = x11 - x01;
    *gradient = Vec3{dx0 + t[2] * (dx1 - dx0), dy0 + t[2] * (dy1 - dy0), y1 - y0} / grid.cell;
  }
  double const distance2 = norm2(out);
  if (!(distance2 > 0)) return inside;
  double const continued = std::sqrt(inside * inside + distance2);
  if (gradient)
    for (int i = 0; i < 3; ++i) (*gradient)[i] = -(out[i] != 0 ? out[i] : inside * (*gradient)[i]) / continued;
  return -continued;
}

}  // namespace scree
