// library_target.h: what a library must do once a reader has accepted it: have no problems, and answer for phi.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/shape.h"
#include "tests/fuzz/fuzz_input.h"

namespace scree::fuzz {

// `library` has passed its reader's checks.
inline void check_library(Library const& library) {
  must(problems(library).empty(), "a library that was read is valid");
  for (Shape const& s : library.shape) {
    Vec3 gradient;
    for (Vec3 const& x : {Vec3{}, Vec3{0.3, -0.2, 0.1}, Vec3{1, 2, 3}}) evaluate_reference(library, s, x, &gradient);
  }
}

}  // namespace scree::fuzz
