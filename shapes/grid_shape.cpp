// grid_shape.cpp: see grid_shape.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/grid_shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

// A cube with the values at its corners (bit k of the index: upper side of axis k), and halves of it.
struct Cube {
  Vec3 min;
  double edge = 0;
  double value[8] = {};

  double at(Vec3 t) const {  // t: 0..1
    double sum = 0;
    for (int n = 0; n < 8; ++n)
      sum += value[n] * (n & 1 ? t.x : 1 - t.x) * (n & 2 ? t.y : 1 - t.y) * (n & 4 ? t.z : 1 - t.z);
    return sum;
  }
  Cube eighth(int part) const {
    Cube c;
    c.edge = edge / 2;
    Vec3 const corner{part & 1 ? 0.5 : 0.0, part & 2 ? 0.5 : 0.0, part & 4 ? 0.5 : 0.0};
    c.min = min + corner * edge;
    for (int n = 0; n < 8; ++n) c.value[n] = at(corner + Vec3{n & 1 ? 0.5 : 0.0, n & 2 ? 0.5 : 0.0, n & 4 ? 0.5 : 0.0});
    return c;
  }
  int positive_corners() const {
    return static_cast<int>(std::count_if(value, value + 8, [](double v) { return v > 0; }));
  }
  // Smallest box around the part with phi > 0: along each axis the reach of its edges' positive parts.
  Box positive_part() const {
    Box part{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (int axis = 0; axis < 3; ++axis)
      for (int n = 0; n < 8; ++n) {
        if (n >> axis & 1) continue;
        double const low = value[n], high = value[n | 1 << axis];
        if (!(low > 0) && !(high > 0)) continue;
        double const zero = low / (low - high);  // used where the signs differ
        part.min[axis] = std::min(part.min[axis], min[axis] + edge * (low > 0 ? 0 : zero));
        part.max[axis] = std::max(part.max[axis], min[axis] + edge * (high > 0 ? 1 : zero));
      }
    return part;
  }
  // Bound of |grad phi|.
  double steepest() const {
    Vec3 most;
    for (int axis = 0; axis < 3; ++axis)
      for (int n = 0; n < 8; ++n)
        if (!(n >> axis & 1)) most[axis] = std::max(most[axis], std::abs(value[n | 1 << axis] - value[n]));
    return norm(most) / edge;
  }
};

double farthest_corner(Box const& box) {
  Vec3 far;
  for (int i = 0; i < 3; ++i) far[i] = std::max(std::abs(box.min[i]), std::abs(box.max[i]));
  return norm(far);
}

// Upper bound of |x| over the solid part of the cube, refined `depth` times where it exceeds `known`.
double farthest_point(Cube const& cube, double known, int depth) {
  if (cube.positive_corners() == 0) return 0;
  double const bound = farthest_corner(cube.positive_part());
  if (depth == 0 || bound <= known) return bound;
  double far = 0;
  for (int part = 0; part < 8; ++part) far = std::max(far, farthest_point(cube.eighth(part), known, depth - 1));
  return far;
}

template <class Visit>
void for_each_cube(SdfGrid const& grid, Visit const& visit) {
  GridFrame const& f = grid.frame;
  for (int k = 0; k + 1 < f.nz; ++k)
    for (int j = 0; j + 1 < f.ny; ++j)
      for (int i = 0; i + 1 < f.nx; ++i) {
        Cube cube;
        cube.min = f.origin + Vec3{double(i), double(j), double(k)} * f.cell;
        cube.edge = f.cell;
        for (int n = 0; n < 8; ++n)
          cube.value[n] = grid.value[(std::size_t(k + (n >> 2)) * f.ny + (j + (n >> 1 & 1))) * f.nx + (i + (n & 1))];
        visit(cube);
      }
}

}  // namespace

void set_grid(Library const& library, int index, Shape& shape) {
  SdfGrid const& grid = *library.grid.at(static_cast<std::size_t>(index));
  shape.kind = ShapeKind::grid;
  shape.data = index;
  shape.lipschitz = 1;
  Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  double known = 0;  // |x| of points that belong to the solid
  for_each_cube(grid, [&](Cube const& cube) {
    int const positive = cube.positive_corners();
    if (positive < 8) shape.lipschitz = std::max(shape.lipschitz, cube.steepest());
    if (positive == 0) return;
    Box const part = cube.positive_part();
    for (int i = 0; i < 3; ++i) {
      box.min[i] = std::min(box.min[i], part.min[i]);
      box.max[i] = std::max(box.max[i], part.max[i]);
    }
    for (int n = 0; n < 8; ++n)
      if (cube.value[n] > 0)
        known = std::max(known, norm(cube.min + Vec3{double(n & 1), double(n >> 1 & 1), double(n >> 2)} * cube.edge));
  });
  if (!(box.max.x > box.min.x)) throw std::runtime_error("the grid holds no point with phi > 0");
  shape.box = box;
  shape.bounding_radius = known;
  for_each_cube(grid, [&](Cube const& cube) {
    int constexpr depth = 3;  // an eighth of a cell, whose diagonal is a fifth of one
    shape.bounding_radius = std::max(shape.bounding_radius, farthest_point(cube, shape.bounding_radius, depth));
  });
}

}  // namespace scree
