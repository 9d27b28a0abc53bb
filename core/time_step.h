// time_step.h: the automatic step: a share of the critical step at the worst impact the scene can produce.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene.h"

namespace scree {

struct StepEstimate {
  double critical = 0;  // [s]; infinity when nothing can touch
  double accurate = 0;  // step at which nodes may enter without spoiling the ledger [s]; infinity without nodes
  double speed = 0;     // of the worst impact [m/s]
  double overlap = 0;   // it would reach [d]
};

// Speed from the energy available (start velocities, fall to the lowest wall), overlap of a smooth body of the grain's
// size at that speed, flat faces by their area; stiffness and lever arms as in critical_time_step().
StepEstimate estimate_critical_step(Case const& c, Scene const& scene, Placement const& placement);

// Overlap of a grain that meets its like head-on at `speed` [m/s], but at least that of a contact that carries its
// weight; 0 where its material never meets itself [d].
double overlap_at_speed(Case const& c, Scene const& scene, int body, double speed);

// Weight the softest material pair carries at 1 % d, in weights of its heaviest grain (design physics.md section 4).
double load_in_grain_weights(Case const& c, Scene const& scene);

// Load check: of every two materials that meet, would the heaviest grain sink deeper than limits.overlap into the
// smallest one by its weight alone? One line a pair, with the kappa or stiffness that would carry it; empty without
// gravity.
std::vector<std::string> load_problems(Case const& c, Scene const& scene);

}  // namespace scree
