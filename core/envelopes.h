// envelopes.h: what grains did on their way, from frames of results: run-out, map, energies at screens, speeds.
// Pools the replicas of all files; tables as in tools/README.md.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernels/base/vec.h"

namespace scree {

struct EnvelopeOptions {
  std::optional<Vec3>
      direction{};  // of the run-out, its horizontal part; none: that of the case's first run_out measure
  double bin = 0;   // width of bins and cells, distance of screens [m]; 0: 1, 2 or 5 times 10^k, about 30 on the way
  bool recover = false;  // read unfinished files
};

// Of a sample; percentiles are linear between its ordered values. NaN without any.
struct SampleSpread {
  int count = 0;
  double mean, low, high, largest;  // low, high: 5 and 95 %
};
SampleSpread spread_of(std::vector<double> sample);

enum class Fate { stopped, moving, left };  // moving: above 0.05 sqrt(g d) in the last frame; left: deleted
char const* to_string(Fate fate);

struct GrainWay {
  int file, replica, body, group;  // group: of Envelopes::group
  Fate fate = Fate::stopped;
  Vec3 release{}, end{};             // where it was first, and last or when it was deleted [m]
  double run_out = 0, sideways = 0;  // way along the direction and to the left of it [m]
  double largest_speed = 0;          // at frames [m/s]
};

struct EnvelopeGroup {
  struct Bin {
    double from;        // run-out from here to the next one [m]
    int stopped, left;  // grains that ended there; those that still move count as stopped
    double beyond;      // share of all grains that came as far as `from`
  };
  struct Cell {
    double along, across;       // its centre: world position along the direction and to the left of it [m]
    int passed, stopped, left;  // grains that were in it at any time; that ended in it
  };
  struct Screen {
    double along;         // world position along the direction [m]
    SampleSpread energy;  // kinetic energy per mass of each grain when it first comes through [J/kg]
    double rotation = 0;  // mean of what of it is rotation [J/kg]
  };
  struct Moment {
    double time;         // since each grain's release [s]
    SampleSpread speed;  // of all grains that are there, at rest or not [m/s]
  };

  std::string name;
  int replicas = 0;  // in all files together
  int grains = 0;
  SampleSpread run_out;
  double widest = 0, sideways = 0;  // largest size and standard deviation of GrainWay::sideways [m]
  std::vector<Bin> bin;
  std::vector<Cell> cell;
  std::vector<Screen> screen;
  std::vector<Moment> moment;
};

struct Envelopes {
  Vec3 along, across;                // horizontal unit vectors
  double bin = 0;                    // [m]
  double every = 0;                  // time between moments: output.every of the first file [s]
  int waiting = 0;                   // grains that no frame has: not inserted yet, counted nowhere
  std::vector<EnvelopeGroup> group;  // [[grains]] entries by name, in the order in which the files have them
  std::vector<GrainWay> grain;
};

// Reads every file twice, frame by frame. Between two frames a grain goes straight; its energy is that of a flight,
// exact without contact, and between the energies of the two frames (less (g dt)^2/8) with one. Deterministic.
// Throws InputError: a file that cannot be read, has fewer than two frames or is named twice, no direction or a
// vertical one, a bin that is not positive.
Envelopes measure_envelopes(std::vector<std::filesystem::path> const& results, EnvelopeOptions const& options);

// The tables' names, and their files in `folder`: groups, grains, run_out, plan, screens and velocity, each .csv.
std::vector<std::filesystem::path> envelope_files(std::filesystem::path const& folder);
// Throws std::system_error naming the file that cannot be written.
void write_envelopes(Envelopes const& envelopes, std::filesystem::path const& folder);

}  // namespace scree
