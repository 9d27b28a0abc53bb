// report_scene.h: grains and walls of one frame as data of the report's orbitable view.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "core/results.h"

namespace scree {

// JSON: shapes as light meshes (16-bit coordinates, base64), a row for each grain [shape, x, y, z, qw, qx, qy, qz, d,
// speed, kind, entry, deepest overlap in d], walls as triangles, the box to look at, and a note on what is left out.
// Below some 3 MB. `threads` measure overlaps and change no bit.
std::string scene_json(ResultsHeader const& header, Frame const& frame, int threads);

}  // namespace scree
