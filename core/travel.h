// travel.h: how far surfaces move in a step, against how thin the bodies are that they meet.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state.h"

namespace scree {

// A node that comes to this share of a thin part's half thickness stops the run: behind the middle phi falls again, and
// the contact would push it out on the far side.
double constexpr deepest_share = 0.8;
// A pair may approach by this share of the half thickness of its thinner body in a step, so that no node can pass from
// above 0.8 on one side to below 0.8 on the other unseen.
double constexpr largest_travel = 0.25;

// Upper bound of the speed of any point of a body [m/s].
double surface_speed(Scene const& scene, State const& state, int body);

struct PairTravel {
  double share = 0;  // largest approach in a step, in half thicknesses of the thinner body of its pair
  int pair = -1;
};
// Whether some pair may approach by more than largest_travel: false is certain, and needs no look at the pairs.
bool pairs_may_travel_far(Scene const& scene, State const& state);
PairTravel largest_pair_travel(Scene const& scene, State const& state, std::vector<Pair> const& pair);

// Of the thinnest grain or wall [m]; 1e300: all are without a middle.
double least_half_thickness(Scene const& scene);

}  // namespace scree
