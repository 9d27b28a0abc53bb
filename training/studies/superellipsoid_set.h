// superellipsoid_set.h: the 125 superellipsoids of the benchmark set, the reference paper's Fig. 8.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"
#include "training/dataset.h"

namespace scree {

// Values that elongation EI = b/a and flatness FI = c/b take, and those of the exponent (both exponents are equal).
// Semi-axes a >= b >= c; 0.2 is close to a box, 1 an ellipsoid, 1.8 close to an octahedron.
std::array<double, 5> constexpr superellipsoid_ratios{0.4, 0.55, 0.7, 0.85, 1.0};
std::array<double, 5> constexpr superellipsoid_exponents{0.2, 0.6, 1.0, 1.4, 1.8};

struct SetSuperellipsoid {
  double elongation = 1;  // EI
  double flatness = 1;    // FI
  double exponent = 1;
  Shape shape;  // volume pi/6 in closed form; named "superellipsoid/e0.2-ei0.40-fi0.55"
};

SetSuperellipsoid set_superellipsoid(double elongation, double flatness, double exponent);

// All 125: the exponent changes slowest, then elongation, then flatness.
std::vector<SetSuperellipsoid> superellipsoid_set();

// Closed, all vertices on the surface, sharp edges followed; about 18 cells^2 triangles.
TriangleMesh superellipsoid_mesh(Shape const& shape, int cells = 24);

// With the formula as truth and superellipsoid_mesh as its surface.
Body superellipsoid_body(SetSuperellipsoid const& s);

}  // namespace scree
