// phi_batch.h: the signed distance of one shape at many points, as the geometry routines take it.
// Two providers of the same phi: the double reference and the fast float batch.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "kernels/base/span.h"
#include "shapes/shape.h"

namespace scree {

// phi[i] and, unless `gradient` is empty, its gradient at point[i] (units of d, body frame; phi > 0 inside).
using PhiBatch = std::function<void(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient)>;

// The readable reference. Holds references: library and shape must outlive it. Thread-safe.
PhiBatch reference_phi(Library const& library, Shape const& shape);

// Networks through sdf_forward(_gradient) (float, error 1e-5), every other kind as the reference, with `threads` OpenMP
// threads. Owns what it needs. Same bits for any number of threads. Thread-safe.
PhiBatch fast_phi(Library const& library, Shape const& shape, int threads = 1);

// What surface construction uses: fast_phi, but for superellipsoids and radii the gauge r_in (1 - rho(x)), which has
// the same zero set and the same normals there; its Lipschitz constant is that of the shape or less, inside too, where
// the radial distance has none, and for superellipsoids it costs a hundredth of the true distance.
PhiBatch surface_phi(Library const& library, Shape const& shape, int threads = 1);

// Lipschitz bound of surface_phi inside and outside, as find_zero_set takes it; 0 for grids, which have one outside
// only.
double surface_lipschitz(Shape const& shape);

// Move points onto phi = 0 by `steps` Newton steps along the gradient, none further than `reach` from where it began.
// `gradient` receives the gradient at the final points, phi (may be empty) the remaining phi.
void project_to_surface(PhiBatch const& phi, Span<Vec3> point, Span<Vec3> gradient, double reach, int steps = 4,
                        Span<double> remaining = {});

}  // namespace scree
