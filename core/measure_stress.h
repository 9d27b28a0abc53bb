// measure_stress.h: what contact forces do inside a region: mean stress, force chains, and the contacts themselves.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/measure_kinds.h"

namespace scree {

// Where the force of pair k of the list acts [m]: on its line, as far from a's centroid as the contact is
// (PairResult::arm2_a); on the side that a push comes from, or that adhesion pulls to. On a wall that is a body every
// force is taken for a push.
Vec3 contact_point(MeasureView const& view, std::size_t k);

// Love-Weber: sigma_ij = -(1/V) sum of F_i l_j over contacts, F the force on a, l the branch from a's centroid to b's
// (to the contact point on a wall), times the share of the branch that lies in the region: exact for uniform stress and
// continuous as grains move. Symmetric part; compression is positive; the grains' own motion and the couples of rolling
// resistance do not enter. Christoffersen, Mehrabadi, Nemat-Nasser, J. Appl. Mech. 48 (1981) 339, with the sign of
// soils. xx yy zz xy xz yz, pressure (a third of the trace), deviator sqrt(3/2 s:s) [Pa].
std::vector<Quantity> stress_quantities(MeasureView const& view);
Values sample_stress(MeasureView const& view, Memory& memory);

// Contacts between grains (points in the region) with a force above `above` times their mean force: count, their share
// of the contacts and of the sum of forces; mean and largest force [N]. Two bodies make one contact.
std::vector<Quantity> chain_quantities(MeasureView const& view);
Values sample_chains(MeasureView const& view, Memory& memory);

// A contact of the last step as it is written down.
struct ContactRow {
  int a, b;           // grain; grain, -1 - wall of the case
  Vec3 point, force;  // [m]; on a [N]
};
// All contacts in the region of the measurement, walls too, in the order of the pair list.
std::vector<ContactRow> contacts_of(MeasureView const& view);

}  // namespace scree
