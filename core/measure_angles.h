// measure_angles.h: the angle of repose of a heap, and that of the bed of a rotating drum.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/measure_kinds.h"

namespace scree {

// Heap: grains of the region that contacts connect to a wall (what falls onto it does not belong to it yet, even where
// two meet in flight) about a vertical axis
// through `through`, else through their centre of mass; with `direction` one-dimensional along it. See fit_heap.
// angle [deg] of the flank, height of the highest ring above the lowest grain, both at their tops (centroid +- d/2)
// [m], rms of the centroids about the line [m].
std::vector<Quantity> pile_quantities(MeasureView const& view);
Values sample_pile(MeasureView const& view, Memory& memory);

// Drum: seen along its axis, centroids of the highest grains of cells one `bin` wide across the drum and along the
// axis, in the middle third of its width (2 radius, of the wall's cylinder or the key; else of the grains' extent); a
// straight line by least squares, again without what lies farther than 1.5 bins off it. angle [deg]: positive where the
// surface rises on the side on which the turning wall carries grains up; without a `wall` that turns, where it rises
// towards axis x up. offset: height of the line above the axis [m]; rms of the heights [m].
std::vector<Quantity> surface_quantities(MeasureView const& view);
Values sample_surface(MeasureView const& view, Memory& memory);
std::string check_surface(Case const& c, MeasureCase const& m);

}  // namespace scree
