// measure_packing.h: the share of a region that grains fill.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/measure_kinds.h"

namespace scree {

// Grains that are wholly inside count with their exact volume pi d^3/6; a grain that the region's border cuts with the
// share of a fixed quasi-random point set (Halton, `points` inside its shape) that lies in the region. `error`:
// standard error if the points were random, sqrt(p (1 - p) / n) of each cut grain; the set does better. Overlaps count
// twice. Of several replicas the mean.
std::vector<Quantity> packing_quantities(MeasureView const& view);
Values sample_packing(MeasureView const& view, Memory& memory);

// `count` points of a shape's inside, quasi-random and evenly spread, body frame [d]; fewer for a shape that fills less
// than 1/64 of its box. Deterministic.
std::vector<Vec3> points_inside(Library const& library, Shape const& shape, int count);

}  // namespace scree
