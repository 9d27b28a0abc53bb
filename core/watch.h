// watch.h: what is looked at after every step: finite? overlap? step stable? at rest?
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/state.h"

namespace scree {

struct WatchReport {
  double overlap = 0;  // largest, in diameters of the smaller grain of its pair
  int overlap_pair = -1;
  double depth = 0;  // largest overlap over the half thickness of the body that the node is in
  int depth_pair = -1;
  double kinetic_largest = 0;  // over grains, in m g d
  double kinetic_total = 0;    // [J]
  int not_finite = -1;         // first body with a non-finite state; -1: none
};

// Fills work.kinetic. g: acceleration that m g d is made with [m/s2].
WatchReport watch(Queue const& queue, Scene const& scene, State& state, double g, Workspace& work);

// "grain 12 (ballast/3)" or "wall 'floor'", for messages.
std::string describe_body(Scene const& scene, int body);
std::string describe_pair(Scene const& scene, Case const& c, Pair pair);

}  // namespace scree
