// measure_flow.h: mass and number of grains that leave, through a plane or at a [[delete]] entry.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/measure_kinds.h"

namespace scree {

// Through a plane: centroids that pass it along `normal` count, those that come back are taken off again; with `radius`
// only within that distance of `point`. By `delete`: the grains that the entry of this name takes.
// mass_rate [kg/s] and number_rate [1/s] since the last sample; mass [kg] and number since the start.
std::vector<Quantity> discharge_quantities(MeasureView const& view);
void visit_discharge(MeasureView const& view, double dt, Memory& memory);
Values sample_discharge(MeasureView const& view, Memory& memory);
std::string check_discharge(Case const& c, MeasureCase const& m);

}  // namespace scree
