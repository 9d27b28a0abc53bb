// effects.h: what a case calls for, and the stages and arrays that follow from it.
// An absent key is an absent effect: no stage, no array, no column. One function decides, `scree plan` prints it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case.h"
#include "core/scene.h"

namespace scree {

struct Effects {
  bool sphere_contacts = false;  // closed-form spheres exist
  bool node_contacts = false;    // shapes with surface nodes exist
  bool networks = false;         // ... some of them neural,
  bool harmonics = false;        // ... radii,
  bool grids = false;            // ... grids,
  bool meshes = false;           // ... meshes
  bool analytic_nodes = false;   // nodes meet planes or analytic shapes
  bool friction = false;
  bool rolling = false;  // rolling resistance
  bool cohesion = false;
  bool damping = false;
  bool gravity = false;
  bool wall_motion = false;
  bool force = false;  // applied forces or torques
  bool drag = false;
  bool global_damping = false;  // [damping], all the time
  bool insertion = false;       // over time
  bool deletion = false;
  bool measures = false;        // [[measure]]
  bool settle = false;          // the settle schedule ...
  bool settle_damping = false;  // ... with a global damping that it switches
};

Effects effects_of(Case const& c, Scene const& scene);

// Stages in order of execution, e.g. {"bounds", "broad_phase", "sphere_contacts", "gravity", "integrate", "watch"}.
std::vector<std::string> stages_of(Effects const& effects);

// Effects by name, in the words of the case file.
std::vector<std::string> names_of(Effects const& effects);

// Columns of the ledger beyond those that every run has (core/results_layout.h).
std::vector<std::string> ledger_columns_of(Effects const& effects);

}  // namespace scree
