// envelope_legs.h: the ways of grains from frame to frame, as envelopes read them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/results.h"

namespace scree {

// What envelopes need of a results file's case.
struct EnvelopeCase {
  std::vector<std::string> group;  // names of [[grains]]
  Vec3 gravity;                    // [m/s2]
  double every = 0;                // output.every [s]
  std::optional<Vec3> direction;   // of the first run_out measurement
};
EnvelopeCase envelope_case(ResultsHeader const& header, std::string const& file);  // file: for messages

// What a grain has at a moment, per mass where it is an energy.
struct GrainMoment {
  double time = 0;                  // [s]
  Vec3 position, velocity;          // [m], [m/s]
  double energy = 0, rotation = 0;  // kinetic energy per mass, and the rotation's part of it [J/kg]
};

// From one frame to the next.
struct GrainLeg {
  int body;
  GrainMoment from, to;
  // Deleted on this leg: `to` is where it left, with the energy of a flight to there; the moment is not known.
  bool leaves = false;
  double sag = 0;  // (g dt)^2 / 2: a flight's energy is this times f (1 - f) below the straight line [J/kg]

  // At the share f of the leg, 0..1.
  double energy(double f) const { return (1 - f) * from.energy + f * to.energy - f * (1 - f) * sag; }
  double rotation(double f) const { return (1 - f) * from.rotation + f * to.rotation; }
  double speed(double f) const { return norm(from.velocity * (1 - f) + to.velocity * f); }
};

// Calls `release` with each grain's first moment and `leg` with all that follow, frame by frame.
void walk_legs(ResultsReader const& reader, Vec3 gravity,
               std::function<void(int body, GrainMoment const&)> const& release,
               std::function<void(GrainLeg const&)> const& leg);

}  // namespace scree
