// wall_motion.h: prescribed motion of walls as exact functions of time: nothing is summed up, so a restart needs no
// state of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/case.h"

namespace scree {

// Where a wall's motion has taken it since time 0.
struct WallShift {
  Vec3 translation;  // [m]
  double angle = 0;  // about the axis through MotionCase::through [rad]
};
WallShift shift_at(MotionCase const& motion, double time);

// Pose at `time` of a wall that stands at `position`, `orientation` at time 0.
struct WallPose {
  Vec3 position;
  Quat orientation;
};
WallPose pose_at(MotionCase const& motion, Vec3 position, Quat orientation, double time);

// Rotation rate about the motion's axis [rad/s] at `time`; 0 for translations.
double rate_at(MotionCase const& motion, double time);

// Largest speed that any point within `radius` of `centre` has during the run [m/s].
double fastest(MotionCase const& motion, Vec3 centre, double radius);

}  // namespace scree
