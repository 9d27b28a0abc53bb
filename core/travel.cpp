// travel.cpp: see travel.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/travel.h"

#include <algorithm>

namespace scree {
namespace {

double half_thickness_of(Scene const& scene, int body) {
  return scene.shape[scene.shape_of[body]].half_thickness * scene.diameter[body];
}

// Of its points by turning [m/s].
double turning_speed(Scene const& scene, State const& state, int body) {
  if (body >= scene.bodies()) return norm(state.angular_momentum[body]) * scene.wall[body - scene.bodies()].reach;
  Vec3 const spin = spin_of(state.orientation[body], scene.inertia[body], state.angular_momentum[body]);
  return norm(spin) * scene.shape[scene.shape_of[body]].bounding_radius * scene.diameter[body];
}

}  // namespace

double surface_speed(Scene const& scene, State const& state, int body) {
  return norm(state.velocity[body]) + turning_speed(scene, state, body);
}

bool pairs_may_travel_far(Scene const& scene, State const& state) {
  double fastest = 0;
  for (int i = 0; i < scene.solids(); ++i) fastest = std::max(fastest, surface_speed(scene, state, i));
  double constexpr margin = 1 + 1e-9;  // of rounding: the sum over a pair is not this bound's
  return 2 * fastest * state.time_step * margin > largest_travel * least_half_thickness(scene);
}

PairTravel largest_pair_travel(Scene const& scene, State const& state, std::vector<Pair> const& pair) {
  PairTravel out;
  std::vector<double> turning(scene.solids());  // a body has many pairs
  for (int i = 0; i < scene.solids(); ++i) turning[i] = turning_speed(scene, state, i);
  for (std::size_t k = 0; k < pair.size(); ++k) {
    Pair const p = pair[k];
    if (p.with_plane()) continue;  // a half space has no far side
    double const thin = std::min(half_thickness_of(scene, p.a), half_thickness_of(scene, p.b));
    double const speed = norm(state.velocity[p.a] - state.velocity[p.b]) + turning[p.a] + turning[p.b];
    if (speed * state.time_step > out.share * thin)
      out.share = speed * state.time_step / thin, out.pair = static_cast<int>(k);
  }
  return out;
}

double least_half_thickness(Scene const& scene) {
  double least = 1e300;
  for (int i = 0; i < scene.solids(); ++i) least = std::min(least, half_thickness_of(scene, i));
  return least;
}

}  // namespace scree
