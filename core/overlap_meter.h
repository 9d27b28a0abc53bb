// overlap_meter.h: how deep the grains of a frame are inside each other and inside walls, measured without the nodes.
// A dense surface set of its own per shape against the double reference phi: the engine's nodes see less than is there.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/results.h"

namespace scree {

// Two bodies, or a body and a wall. Depths are in units of the smaller d of the two.
struct OverlapAt {
  double depth = 0;  // [d]; 0: no such contact
  int a = -1;        // body; -1: none
  int b = -1;        // body > a, or -1 - wall: index into ResultsHeader::wall and, after its last, ::wall_body
};

struct OverlapReport {
  OverlapAt grain_grain, grain_wall;  // the deepest of each kind
  double mean = 0;                    // of the contacts' depths [d]
  double p99 = 0;                     // of the contacts' depths: 99 % are not deeper [d]
  int contacts = 0;                   // pairs with some point inside, walls included
  int wall_contacts = 0;              // those with walls
  double coordination = 0;            // contacts a grain has on average, walls included
  std::vector<double> of_body;        // each body's deepest contact, with grains or walls [d] (n_bodies)
};

// Every point of each grain's dense surface (at least `points_per_grain`, the same for all grains of a shape) is tested
// against every grain whose bounding sphere it is in, and against all walls. As in the engine, nothing outside a
// bounding sphere is inside the grain. A depth is a lower bound: between points spaced s it misses s^2 / (4 R) for
// local radius R; against a wall body it is the phi of its solid, as the engine had it. Same bits for any number of
// threads. Cost: 1 s a core for some 5 million points near a partner. Throws std::invalid_argument when the frame and
// the header disagree in the number of bodies or moving walls.
OverlapReport measure_overlap(ResultsHeader const& header, Frame const& frame, int points_per_grain, int threads);

}  // namespace scree
