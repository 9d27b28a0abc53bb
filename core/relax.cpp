// relax.cpp: see relax.h. A preconditioned descent in the elastic energy; there is no time in it.
// SPDX-License-Identifier: Apache-2.0
#include "core/relax.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/watch.h"

namespace scree {
namespace {

// Both bodies of a pair move, each by a share of force over stiffness below one half: no pair is thrown past its rest.
double constexpr descent = 0.4;
// A pair whose nodes' forces cancel to this share of stiffness x overlap pushes nobody.
double constexpr cancelled = 1e-6;

// The descent is stalled when so many passes took less than so much off the deepest overlap: grains hold each other
// where no small move helps, like two plates that cross. Then the deep pairs are pushed apart for as many passes.
int constexpr stall_passes = 40;
double constexpr stall_share = 0.05;

struct Deepest {
  double overlap = 0;  // [d] of the smaller grain
  int pair = -1;
  double energy = 0;  // of all contacts [J]
};

Deepest deepest_contact(Scene const& scene, Workspace const& work) {
  Deepest out;
  for (std::size_t k = 0; k < work.pair.size(); ++k) {
    Pair const p = work.pair[k];
    bool const wall = p.with_plane() || p.b >= scene.bodies();
    double const d = wall ? scene.diameter[p.a] : std::min(scene.diameter[p.a], scene.diameter[p.b]);
    out.energy += work.result[k].energy_normal;
    if (work.result[k].overlap > out.overlap * d)
      out.overlap = work.result[k].overlap / d, out.pair = static_cast<int>(k);
  }
  return out;
}

// Directions of a golden spiral: different pairs part differently, the same pair always alike.
Vec3 parting_direction(Pair p) {
  double const golden = 0.6180339887498949, i = p.a + 0.5 * p.b + 1;
  double const z = 2 * (golden * i - std::floor(golden * i)) - 1, r = std::sqrt(1 - z * z),
               turn = 2.399963229728653 * i;
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// What parts pairs that no descent parts, of each body [m]: those whose forces cancel and, where the descent is
// stalled, the deep ones. `deepest` [d].
void push_apart(Scene const& scene, Workspace const& work, double travel, bool stalled, double deepest,
                std::vector<Vec3>& push) {
  std::fill(push.begin(), push.end(), Vec3{});
  for (std::size_t k = 0; k < work.pair.size(); ++k) {
    Pair const p = work.pair[k];
    PairResult const& r = work.result[k];
    if (p.with_plane() || !(r.overlap > 0)) continue;
    bool const balanced = norm(r.elastic.force_on_a) <= cancelled * r.stiffness * r.overlap;
    bool const deep = r.overlap > 0.5 * deepest * std::min(scene.diameter[p.a], scene.diameter[p.b]);
    if (!balanced && !(stalled && deep)) continue;
    Vec3 const way = parting_direction(p) * (0.25 * travel);
    push[p.a] += way * scene.diameter[p.a];
    if (p.b < scene.bodies()) push[p.b] -= way * scene.diameter[p.b];
  }
}

// One pass: along the contact's force and torque, and the push, no point further than `travel` [d].
void move_grain(Scene const& scene, int i, double travel, Vec3 push, State& state) {
  Wrench const& w = state.wrench.elastic[i];
  double const rate = state.wrench.stiffness[i] > 0 ? descent / state.wrench.stiffness[i] : 0;  // [s^2]
  Vec3 shift = w.force * (rate / scene.mass[i]) + push;
  Vec3 turn = inverse_inertia_times(to_matrix(state.orientation[i]), scene.inertia[i], w.torque) * rate;
  double const d = scene.diameter[i], reach = scene.shape[scene.shape_of[i]].bounding_radius * d;
  double const way = norm(shift) + reach * norm(turn);
  if (way > travel * d) shift = shift * (travel * d / way), turn = turn * (travel * d / way);
  state.position[i] += shift;
  state.orientation[i] = normalized(quat_from_rotation_vector(turn) * state.orientation[i]);
}

}  // namespace

std::string relax_overlaps(Queue const& queue, Case const& c, Scene const& scene, Effects const& effects,
                           ContactSettings const& settings, State& state, Workspace& work) {
  RelaxCase const& relax = *c.relax;
  int const n = scene.bodies();
  // At rest while it lasts: nothing slides, nothing damps, and node lists expect no motion but what they measure.
  std::vector<Vec3> const velocity = state.velocity, momentum = state.angular_momentum;
  std::fill(state.velocity.begin(), state.velocity.begin() + n, Vec3{});
  std::fill(state.angular_momentum.begin(), state.angular_momentum.begin() + n, Vec3{});
  std::vector<Vec3> push(n);  // [m]
  Deepest first, now;
  int pass = 0;
  bool stalled = false;
  double before = 0;  // deepest overlap when that was last decided [d]
  for (;; ++pass) {
    evaluate_contacts(queue, scene, effects, settings, 0, state, work);
    now = deepest_contact(scene, work);
    if (pass == 0) first = now;
    if (now.overlap <= relax.overlap || pass == relax.passes) break;
    if (pass % stall_passes == 0) {
      stalled = pass > 0 && now.overlap > (1 - stall_share) * before;
      before = now.overlap;
    }
    push_apart(scene, work, relax.travel, stalled, now.overlap, push);
    for (int i = 0; i < n; ++i)
      if (state.is_active(i)) move_grain(scene, i, relax.travel, push[i], state);
  }
  if (now.overlap > relax.overlap)
    throw InputError({fmt::format(
        "relax: {} still overlap by {:.3g} d after {} passes (at first {:.3g} d, relax.overlap is {:.3g}): there is no "
        "room for them. Insert fewer grains, enlarge the container, or raise relax.passes or relax.overlap",
        describe_pair(scene, c, work.pair[now.pair]), now.overlap, pass, first.overlap, relax.overlap)});
  state.velocity = velocity;
  state.angular_momentum = momentum;
  return fmt::format("relax: {} passes took the largest overlap from {:.3g} d to {:.3g} d and removed {:.4g} J", pass,
                     first.overlap, now.overlap, first.energy - now.energy);
}

}  // namespace scree
