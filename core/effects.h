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
  bool damping = false;
  bool gravity = false;
  bool settle = false;  // global damping, switched by the settle schedule
};

Effects effects_of(Case const& c, Scene const& scene);

// Stages in order of execution, e.g. {"bounds", "broad_phase", "sphere_contacts", "gravity", "integrate", "watch"}.
std::vector<std::string> stages_of(Effects const& effects);

// Effects by name, in the words of the case file.
std::vector<std::string> names_of(Effects const& effects);

}  // namespace scree
