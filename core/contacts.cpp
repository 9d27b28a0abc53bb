// contacts.cpp: see contacts.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/travel.h"
#include "core/wall_bodies.h"
#include "kernels/base/profile.h"
#include "kernels/bounds.h"

namespace scree {
namespace {

// Boxes grow by this part of d, so that the pair list outlives many steps.
double constexpr pair_skin = 0.05;
// Bodies that move by more than this part of their skin in a step are looked for further ahead.
double constexpr fast_way = 0.2;
// Brute force looks far beyond it, so that a pair the boxes missed would show.
double constexpr brute_force_skin = 0.25;

bool pairs_are_stale(Scene const& scene, State const& state, Workspace const& work) {
  if (work.built_position.size() != state.position.size()) return true;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    Quat const f = work.built_orientation[i];
    Quat const turn = Quat{f.w, -f.x, -f.y, -f.z} * state.orientation[i];
    double const half_chord = std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
    ShapeRecord const& shape = scene.shape[scene.shape_of[i]];
    // A ball may turn as it likes.
    double const reach = shape.closed_form_sphere ? 0 : shape.bounding_radius * scene.diameter[i];
    if (!std::isfinite(reach)) continue;  // a wall without bounds is near every grain
    // Both bodies of a pair may use up their own skin.
    if (!(norm(state.position[i] - work.built_position[i]) + 2 * reach * half_chord < work.skin[i])) return true;
  }
  return false;
}

// Rank of a pair in list order: by a, planes first, then b.
bool before(Pair p, Pair q) {
  auto const rank = [](Pair r) {
    return r.with_plane() ? static_cast<std::int64_t>(r.plane()) : (std::int64_t{1} << 40) + r.b;
  };
  return p.a != q.a ? p.a < q.a : rank(p) < rank(q);
}

void match_old_pairs(std::vector<Pair> const& old, std::vector<Pair> const& now, std::vector<int>& old_pair) {
  old_pair.assign(now.size(), -1);
  for (std::size_t i = 0, j = 0; i < now.size(); ++i) {
    while (j < old.size() && before(old[j], now[i])) ++j;
    if (j < old.size() && old[j] == now[i]) old_pair[i] = static_cast<int>(j);
  }
}

template <class T>
void permute(std::vector<T>& values, std::vector<int> const& from, T fresh) {
  std::vector<T> next(from.size(), fresh);
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i] >= 0 && from[i] < static_cast<int>(values.size())) next[i] = values[from[i]];
  values = std::move(next);
}

void set_skins(Scene const& scene, double skin, Workspace& work) {
  work.skin.resize(scene.solids());
  double largest = 0;
  for (int i = 0; i < scene.bodies(); ++i)
    work.skin[i] = skin * scene.diameter[i], largest = std::max(largest, scene.diameter[i]);
  for (int i = scene.bodies(); i < scene.solids(); ++i) work.skin[i] = skin * largest;
}

// What follows from work.pair and from where its pairs were before, work.old_pair.
void assign_pairs(Scene const& scene, SceneView const& view, Workspace& work) {
  work.closed_form.resize(work.pair.size());
  for (std::size_t k = 0; k < work.pair.size(); ++k) {
    Pair const p = work.pair[k];
    work.closed_form[k] = view.shape_record(p.a).closed_form_sphere &&
                          (p.with_plane() || view.shape_record(p.b).closed_form_sphere ||
                           (view.is_wall(p.b) && meets_spheres_in_closed_form(view.shape_record(p.b))));
  }
  assign_sides(view, static_cast<int>(scene.networks.net.size()), work.pair, work.old_pair, work.closed_form,
               work.gather, work.old_side);
  assign_pairs_to_bodies(scene.solids(), work.pair, work.pairs_of_bodies);
}

void rebuild_pairs(Queue const& queue, Scene const& scene, SceneView const& view, double skin, State& state,
                   Workspace& work) {
  set_skins(scene, skin, work);
  work.box.resize(scene.solids());
  std::vector<double> grown = work.skin;  // boxes reach as far as adhesion does
  for (int i = 0; i < scene.solids(); ++i) {
    grown[i] += scene.cohesion_margin;
    // What could cross its partner within a step has to be seen before it does (core/travel.h).
    double const way = surface_speed(scene, state, i) * state.time_step;
    if (way > fast_way * work.skin[i]) grown[i] += way;
  }
  compute_bounds(queue, view, state.view(), grown, work.box);
  std::vector<double> ball(scene.bodies());
  for (int i = 0; i < scene.bodies(); ++i)
    ball[i] = scene.shape[scene.shape_of[i]].bounding_radius * scene.diameter[i] + grown[i];
  find_pairs(queue, view, work.box, {state.position, ball}, work.broad_phase);
  ScopedTimer const timer(queue.profile, "broad_phase/match", work.broad_phase.pair.size());
  match_old_pairs(work.pair, work.broad_phase.pair, work.old_pair);
  work.pair = work.broad_phase.pair;
  work.result.assign(work.pair.size(), {});
  work.in_contact.assign(work.pair.size(), 0);
  assign_pairs(scene, view, work);
  if (scene.friction) {
    permute(state.node_history.first, work.old_side, 0);
    permute(state.node_history.count, work.old_side, 0);
    permute(state.sphere_history.xi, work.old_pair, Vec3{});
    permute(state.sphere_history.stiffness, work.old_pair, 0.0);
  }
  if (scene.rolling) {
    permute(state.rolling_history.angle, work.old_pair, Vec3{});
    permute(state.rolling_history.stiffness, work.old_pair, 0.0);
  }
  work.built_position = state.position;
  work.built_orientation = state.orientation;
  ++work.pair_rebuilds;
}

}  // namespace

void restore_pairs(Scene const& scene, std::vector<Pair> const& pair, std::vector<Vec3> const& built_position,
                   std::vector<Quat> const& built_orientation, Workspace& work) {
  set_skins(scene, pair_skin, work);
  work.pair = pair;
  work.result.assign(pair.size(), {});
  work.in_contact.assign(pair.size(), 0);
  work.old_pair.assign(pair.size(), -1);
  assign_pairs(scene, scene.view(), work);
  work.built_position = built_position;
  work.built_orientation = built_orientation;
}

void evaluate_contacts(Queue const& queue, Scene const& scene, Effects const& effects, ContactSettings const& settings,
                       double dt, State& state, Workspace& work) {
  SceneView const view = scene.view();
  StateView const now = state.view();
  if (settings.brute_force || pairs_are_stale(scene, state, work))
    rebuild_pairs(queue, scene, view, settings.brute_force ? brute_force_skin : pair_skin, state, work);
  compute_kinematics(queue, view, now, work.kinematics);
  KinematicsView const kinematics{work.kinematics.rotation, work.kinematics.spin};
  ContactOptions const options{dt, settings.normalise_gradient};
  RollingView rolling;
  if (effects.rolling) {
    work.next_rolling_history.angle.resize(work.pair.size());
    work.next_rolling_history.stiffness.resize(work.pair.size());
    work.rolling.resize(work.pair.size());
    rolling = {state.rolling_history.angle, state.rolling_history.stiffness, work.next_rolling_history.angle,
               work.next_rolling_history.stiffness, work.rolling};
  }
  if (effects.node_contacts) {
    GatherOptions const gather{dt, settings.skin_steps, settings.brute_force};
    update_node_lists(queue, view, now, kinematics, scene.networks, gather, work.gather);
    find_active_nodes(queue, view, now, kinematics, scene.networks, gather, work.gather.lists, work.active);
    reduce_node_contacts(queue, view, now, kinematics, options, work.pair, work.closed_form, work.gather.lists,
                         work.active, state.node_history, work.next_node_history, work.samples, rolling, work.result,
                         work.in_contact);
  }
  if (effects.sphere_contacts)
    sphere_contacts(queue, view, now, kinematics, options, work.pair, work.closed_form, state.sphere_history,
                    work.next_sphere_history, rolling, work.result, work.in_contact);
  if (effects.friction && effects.node_contacts) std::swap(state.node_history, work.next_node_history);
  if (effects.friction && effects.sphere_contacts) std::swap(state.sphere_history, work.next_sphere_history);
  if (effects.rolling) std::swap(state.rolling_history, work.next_rolling_history);
  reduce_to_bodies(queue, view, work.result, work.in_contact, work.rolling, work.pairs_of_bodies, state.wrench);
}

}  // namespace scree
