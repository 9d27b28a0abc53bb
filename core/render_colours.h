// render_colours.h: the colour of each body in a picture, by what the user wants to see.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/results.h"

namespace scree {

enum class ColourBy {
  kind,   // shape name up to '/' or ':'
  entry,  // [[grains]] entry
  replica,
  speed,    // [m/s]
  spin,     // [rad/s]
  overlap,  // the deepest one, with grains or walls, by the overlap meter on 5,000 surface points a grain [d]
};

ColourBy colour_by(std::string const& name);  // throws std::invalid_argument naming the words
bool is_scale(ColourBy by);                   // a number, not a name
char const* unit_of(ColourBy by);             // of that number; "" for names

// That number of each body; `threads` measure overlaps and change no bit. Throws std::invalid_argument for names.
std::vector<double> body_values(ResultsHeader const& header, Frame const& frame, ColourBy by, int threads);

// Linear RGB of each body. Names take a palette in their order and vary a little from body to body; numbers go from
// dark blue at 0 over green to yellow at `limit` (0: the largest of the frame's active bodies, which is then put
// there).
std::vector<Vec3> body_colours(ResultsHeader const& header, Frame const& frame, ColourBy by, double& limit,
                               int threads);

}  // namespace scree
