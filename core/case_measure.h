// case_measure.h: the user's words about measurements: [[measure]] entries. See case.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/base/vec.h"

namespace scree {

struct MeasureCylinder {
  Vec3 from, to{0, 0, 1};  // ends of the axis [m]
  double radius = 0;       // [m]
};

// One measurement. Which of the keys below the line a kind takes is said in core/measure_kinds.cpp.
struct MeasureCase {
  std::string name, kind;
  std::optional<double> every;  // time between samples [s]; absent: output.every
  double from = 0;              // samples from here ...
  std::optional<double> until;  // ... to here enter mean and spread [s]; absent: to the end
  // ---
  std::optional<Box> box;                    // region [m]; or
  std::optional<MeasureCylinder> cylinder;   // ...
  int slices = 0;                            // of the region: of a box along z, of a cylinder along its axis
  int points = 4096;                         // a shape, where the region cuts its grains
  std::string wall, grains, deletion;        // by name
  std::optional<Vec3> axis, through;         // unit vector or any length; a point [m]
  std::optional<Vec3> direction;             // any length
  std::optional<Vec3> point, normal;         // plane: a point [m]; the normal points to where grains go
  std::optional<double> radius;              // [m]
  std::optional<double> bin;                 // [m]; absent: the largest d of the case
  double flank_low = 0.2, flank_high = 0.8;  // of the height of a heap
  std::optional<double> longer_than;         // [s]
  double above = 1;                          // in mean contact forces
  bool contacts = false;                     // write them, at every sample
  std::vector<double> index;                 // of grains in their entry
};

}  // namespace scree
