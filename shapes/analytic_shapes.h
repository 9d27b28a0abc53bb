// analytic_shapes.h: normalised grains given by a formula: sphere, ellipsoid, superellipsoid, box.
// Volume, inertia, bounding radius and box in closed form; only the area of curved bodies is a quadrature.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "shapes/shape.h"

namespace scree {

// Normalised to volume pi/6, axes along x, y, z in the order given. `axes` are semi-axes or edge lengths in any unit:
// only their ratio counts. Exponents as in AnalyticSdf. Throw std::invalid_argument unless all axes are positive and
// finite, no ratio exceeds 100, and exponents are in 0.1..1.9. Area: relative error below 1e-4.
Shape make_sphere();
Shape make_ellipsoid(Vec3 axes);
Shape make_superellipsoid(Vec3 axes, double exponent_ns, double exponent_ew);
Shape make_box(Vec3 axes);

// A shape from a word: "sphere", "ellipsoid:1:0.8:0.6", "superellipsoid:1:0.8:0.6:0.5" (one exponent, or ns:ew),
// "box:1:1:1". Its name is the word. Throws std::invalid_argument that lists these forms.
Shape builtin_shape(std::string const& spec);

// The word starts with the name of an analytic kind: the case file's shortcut for builtin_shape.
bool is_builtin_shape(std::string const& spec);

}  // namespace scree
