// measure_motion.h: where grains go and how fast: trajectory, velocity, run-out.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/measure_kinds.h"

namespace scree {

// Position [m] and velocity [m/s] of the grains `index` of the entry `grains` (all of them without `index`).
std::vector<Quantity> trajectory_quantities(MeasureView const& view);
Values sample_trajectory(MeasureView const& view, Memory& memory);

// Speeds of the centroids [m/s]: mean, largest, components of the mean velocity; spin: mean rate [rad/s]. Active grains
// of the region, and of `grains` if given.
std::vector<Quantity> velocity_quantities(MeasureView const& view);
Values sample_velocity(MeasureView const& view, Memory& memory);

// From the place where a grain was released (its first position as an active grain) along `direction` [m]: largest and
// mean; sideways, across direction and vertical: largest size and standard deviation. Deleted grains stay where they
// left.
std::vector<Quantity> run_out_quantities(MeasureView const& view);
void visit_run_out(MeasureView const& view, double dt, Memory& memory);
Values sample_run_out(MeasureView const& view, Memory& memory);
std::string check_run_out(Case const& c, MeasureCase const& m);

}  // namespace scree
