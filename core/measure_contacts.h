// measure_contacts.h: what the contacts of the last step tell: coordination.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/measure_kinds.h"

namespace scree {

// Force of the contact on grain a, all parts but couples [N]; zero where nothing touches.
inline Vec3 force_on_a(PairResult const& r) {
  return r.active > 0 ? r.elastic.force_on_a + r.damping.force_on_a + r.friction.force_on_a : Vec3{};
}

// Contacts that carry a force, mean over the grains whose centroid is in the region: with grains, with walls, together;
// and the share of these grains that touch nothing. Two bodies make one contact, however many places they touch at;
// each face of a box wall at rest is a body of its own.
std::vector<Quantity> coordination_quantities(MeasureView const& view);
Values sample_coordination(MeasureView const& view, Memory& memory);

}  // namespace scree
