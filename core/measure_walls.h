// measure_walls.h: force and torque between the grains and a wall, means over the time between samples.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/measure_kinds.h"

namespace scree {

WallCase const* wall_named(Case const& c, std::string const& name);  // null: there is none, or no name

// The keys axis and through, else those of the wall's rotation. Radians a second about it now; 0 for a wall at rest.
Vec3 axis_of(Case const& c, MeasureCase const& m);
Vec3 through_of(Case const& c, MeasureCase const& m);
double rate_of(MeasureView const& view);
std::string check_axis(Case const& c, MeasureCase const& m);  // what is missing; empty: nothing

// Of all contacts (elastic, damping, friction, couples of rolling resistance) on all bodies of the wall: force [N], and
// torque about `through` [N m], at this moment.
Wrench wrench_on_wall(MeasureView const& view, Vec3 through);

// torque: what turns the wall against the grains, minus their torque on it, along the axis [N m]; power = torque x rate
// [W], positive when the wall does work: its integral is the ledger's wall_work of this wall. work: that integral [J].
std::vector<Quantity> torque_quantities(MeasureView const& view);
void visit_torque(MeasureView const& view, double dt, Memory& memory);
Values sample_torque(MeasureView const& view, Memory& memory);
std::string check_torque(Case const& c, MeasureCase const& m);

// Force of the grains on the wall, x, y, z and size of the mean [N].
std::vector<Quantity> wall_force_quantities(MeasureView const& view);
void visit_wall_force(MeasureView const& view, double dt, Memory& memory);
Values sample_wall_force(MeasureView const& view, Memory& memory);

}  // namespace scree
