// energy.cpp: see energy.h. All sums run over bodies and pairs in index order: the same bits for any thread count.
// SPDX-License-Identifier: Apache-2.0
#include "core/energy.h"

#include <cmath>
#include <numeric>

namespace scree {

double mechanical_energy(LedgerRow const& row) {
  return row.kinetic + row.potential + row.elastic_normal + row.elastic_tangential + row.elastic_rolling;
}

LedgerRow make_ledger(Scene const& scene, std::optional<Vec3> gravity, State const& state, Workspace const& work) {
  LedgerRow row;
  row.time = state.time;
  auto const sum = [](std::vector<double> const& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
  row.kinetic = sum(work.kinetic);
  if (gravity)
    for (int i = 0; i < scene.bodies(); ++i)
      if (state.is_active(i)) row.potential -= scene.mass[i] * dot(*gravity, state.position[i]);
  for (PairResult const& r : work.result) {
    row.elastic_normal += r.energy_normal;
    row.elastic_tangential += r.energy_tangential;
  }
  for (RollingResult const& r : work.rolling) row.elastic_rolling += r.energy;
  // Forces do negative work; the ledger lists losses as positive. What friction took and did not store is lost.
  row.damping = -sum(state.work_damping);
  row.friction = -sum(state.work_friction) - row.elastic_tangential;
  row.rolling = -sum(state.work_rolling) - row.elastic_rolling;
  row.wall_work = sum(state.wall_work);
  row.global_damping = sum(state.removed_by_damping);
  row.inserted = state.inserted_energy;
  row.deleted = state.deleted_energy;
  row.drag = sum(state.removed_by_drag);
  row.applied = sum(state.work_applied);
  row.residual = mechanical_energy(row) - state.initial_energy - row.inserted - row.wall_work - row.applied +
                 row.damping + row.friction + row.rolling + row.global_damping + row.drag + row.deleted + row.removed;
  row.moved = std::abs(row.damping) + std::abs(row.friction) + std::abs(row.global_damping) + std::abs(row.wall_work) +
              state.exchanged_kinetic + std::abs(row.removed) + std::abs(row.drag) + std::abs(row.applied) +
              std::abs(row.rolling) + state.kinetic_peak;
  return row;
}

}  // namespace scree
