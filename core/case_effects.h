// case_effects.h: the user's words about effects on bodies: drag, damping, applied forces, deletion. See case.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "core/time_table.h"
#include "kernels/base/vec.h"

namespace scree {

// Quadratic drag of the equal-volume sphere in a fluid: F = -(1/2) density coefficient (pi d^2 / 4) |u| u, u = v -
// fluid.
struct DragCase {
  double density = 0;      // of the fluid [kg/m3]
  double coefficient = 0;  // C_d [-]
  Vec3 fluid_velocity;     // [m/s]
};

// Velocities and spins of all grains decay by exp(-rate t).
struct DampingCase {
  double rate = 0;  // [1/s]
};

// A force and a torque on every grain of one [[grains]] entry, world axes, at the centroid. `table` scales both in time
// (constant beyond its ends); without it they act from `start` to `stop`.
struct ForceCase {
  std::string name, grains;
  Vec3 force, torque;          // on each grain [N], [N m]
  double start = 0;            // [s]
  std::optional<double> stop;  // [s]; absent: to the end
  TimeTable table;             // time [s] -> factor [-]; empty: none
};

// Grains whose centroid is outside or inside a box, or behind a plane, leave for good.
struct DeleteCase {
  std::string name;
  bool plane = false;           // else a box
  bool inside = false;          // box: those inside leave, else those outside
  Vec3 min, max;                // box [m]
  Vec3 point, normal{0, 0, 1};  // plane: a point on it [m]; the normal points into the space that is kept
};

}  // namespace scree
