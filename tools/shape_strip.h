// shape_strip.h: what `scree-shape sample` and `scree-shape interpolate` leave behind.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "shapes/generate.h"

namespace scree {

// The accepted shapes as a model file and, unless `stl` is
// empty, as one mesh a shape in that folder, which is made
// ("ballast/12" becomes ballast_12.stl). Prints what was written. Throws std::invalid_argument when there is none, or
// when a file exists and `force` is not given.
void write_strip(Library const& library, std::vector<Candidate> const& made, std::filesystem::path const& output,
                 std::filesystem::path const& stl, bool force);

}  // namespace scree
