// deletion.cpp: see deletion.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/deletion.h"

#include <fmt/format.h>

#include <algorithm>

#include "kernels/body_effects.h"

namespace scree {
namespace {

std::vector<DeleteRegion> regions_of(Case const& c) {
  std::vector<DeleteRegion> regions;
  for (DeleteCase const& d : c.deletion) regions.push_back({d.plane, d.inside, {d.min, d.max}, d.point, d.normal});
  return regions;
}

void remove_body(Case const& c, Scene const& scene, int body, State& state) {
  double const kinetic = kinetic_energy(scene.view(), state.view(), body);
  state.deleted_energy += kinetic - (c.gravity ? scene.mass[body] * dot(*c.gravity, state.position[body]) : 0);
  state.exchanged_kinetic += kinetic;
  state.activity[body] = Activity::deleted;
  state.velocity[body] = state.angular_momentum[body] = {};
}

// The contacts of leaving bodies end: their forces vanish from the wrenches of this point, which open the next step.
void remove_contacts(Queue const& queue, Scene const& scene, State& state, Workspace& work) {
  auto const leaves = [&](int body) { return body >= 0 && body < scene.bodies() && work.leaving[body] >= 0; };
  for (std::size_t k = 0; k < work.pair.size(); ++k) {
    Pair const p = work.pair[k];
    if (!leaves(p.a) && !leaves(p.b)) continue;
    PairResult& r = work.result[k];
    state.deleted_energy += r.energy_normal + r.energy_tangential;
    // The ledger's friction is what friction took and did not store; what it stored has left, it was not lost.
    state.work_friction[p.a] += r.energy_tangential;
    r = {}, work.in_contact[k] = 0;
    if (work.rolling.empty()) continue;
    state.deleted_energy += work.rolling[k].energy;
    state.work_rolling[p.a] += work.rolling[k].energy;
    work.rolling[k] = {};
  }
  reduce_to_bodies(queue, scene.view(), work.result, work.in_contact, work.rolling, work.pairs_of_bodies, state.wrench);
  work.built_position.clear();
}

}  // namespace

void start_deletion(Case const& c, Scene const& scene, State& state) {
  if (state.activity.empty()) state.activity.assign(scene.bodies(), Activity::active);
  state.deleted.assign(c.deletion.size(), 0);
}

void delete_leaving(Queue const& queue, Case const& c, Scene const& scene, State& state, Workspace& work) {
  std::vector<DeleteRegion> const regions = regions_of(c);
  work.leaving.resize(scene.bodies());
  find_leaving(queue, scene.view(), state.view(), regions, work.leaving);
  bool any = false;
  for (int i = 0; i < scene.bodies(); ++i) {
    if (work.leaving[i] < 0) continue;
    remove_body(c, scene, i, state);
    ++state.deleted[work.leaving[i]];
    any = true;
  }
  if (any) remove_contacts(queue, scene, state, work);
}

void report_deletion(Case const& c, State const& state, std::vector<std::string>& messages) {
  for (std::size_t k = 0; k < c.deletion.size(); ++k)
    if (state.deleted[k] > 0)
      messages.push_back(fmt::format("delete '{}': {} grains left", c.deletion[k].name, state.deleted[k]));
}

}  // namespace scree
