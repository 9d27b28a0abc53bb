// star_radii.h: how far the surface is from the origin along given directions, for bodies whose every ray meets it
// once.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "shapes/phi_batch.h"

namespace scree {

// Distance along each unit direction to the only change of sign of phi within `reach`; empty when some ray has none or
// several. A ray is seen at 64 places: finer folds than reach / 64 are missed. Error 1e-8 reach.
std::vector<double> star_radii(PhiBatch const& phi, std::vector<Vec3> const& direction, double reach);

}  // namespace scree
