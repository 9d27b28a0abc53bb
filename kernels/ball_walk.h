// ball_walk.h: the ways of rays through the balls of grains by sphere tracing, one text for the host and a device.
// Sphere tracing (Hart 1996): steps of |phi| / L along a ray cannot jump over the surface.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/config.h"
#include "kernels/base/vec.h"

namespace scree {

double constexpr walk_tolerance = 1e-4;  // of the surface [d]: half a pixel of a grain 5,000 pixels wide
int constexpr walk_steps = 96;           // a ray this long along a surface has found it for the eye

// In place of a number of steps.
int constexpr walk_hit = -1;   // it stands at the surface
int constexpr walk_left = -2;  // it is past where it had to end

// One step of a walk whose phi [d] where it stands is known; `at`: along the ray [d], `end`: where the ball or what
// else counts ends, `step`: steps made.
SCREE_HD inline void walk_on(double phi, double lipschitz, double end, double& at, int& step) {
  if (phi > -walk_tolerance || ++step == walk_steps) {
    step = walk_hit;
    return;
  }
  at += -phi / lipschitz;
  if (at > end) step = walk_left;
}

// Walks through balls of bodies whose phi is a network's, grouped by network as in QueryBatch.
struct WalkBatch {
  std::vector<Vec3> origin, direction;  // of the ray, in the body's frame [d]; unit
  std::vector<double> end;              // [d]
  std::vector<int> body;
  std::vector<int> group;  // first walk of each network, then the end
  std::vector<double> at;  // changed [d]
  std::vector<int> step;   // changed; 0 or more to begin with
};

}  // namespace scree
