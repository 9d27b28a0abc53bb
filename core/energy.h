// energy.h: the energy ledger: where every joule came from and went.
// kinetic + potential + elastic = initial + wall work + applied + inserted - damping - friction - global damping - drag
//                                 - deleted - removed;
// the residual is what does not close, the energy moved is what it is judged against.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/results.h"
#include "core/state.h"

namespace scree {

// Kinetic plus potential plus elastic energy [J]; potential is -m g . x.
double mechanical_energy(LedgerRow const& row);

// Ledger at a synchronised point. `work.kinetic` must be current.
LedgerRow make_ledger(Scene const& scene, std::optional<Vec3> gravity, State const& state, Workspace const& work);

}  // namespace scree
