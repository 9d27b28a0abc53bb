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

// Arching: no grain has passed the plane (as above) for longer than `longer_than` since the last one, or since `from`,
// while grains remain before it (those of the region, if one is given). blocked: 1 now or 0; count of blockages;
// seconds blocked, from the last passage on; longest wait for a grain [s], short ones too.
std::vector<Quantity> blockage_quantities(MeasureView const& view);
void visit_blockage(MeasureView const& view, double dt, Memory& memory);
Values sample_blockage(MeasureView const& view, Memory& memory);

}  // namespace scree
