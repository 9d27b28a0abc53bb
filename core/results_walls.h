// results_walls.h: the walls of a results file: planes at rest, and bodies with their formulas or triangles.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/results.h"
#include "core/results_hdf5.h"

namespace scree {

void write_walls(hid_t file, std::vector<ResultsWall> const& wall);
std::vector<ResultsWall> read_walls(hid_t file);  // throws std::runtime_error, as does the next

// A file without wall bodies has no group of them.
void write_wall_bodies(hid_t file, std::vector<ResultsWallBody> const& wall);
std::vector<ResultsWallBody> read_wall_bodies(hid_t file);

// Wall bodies that move: frames have a row for each.
std::size_t moving_walls(ResultsHeader const& header);

}  // namespace scree
