// checkpoint.h: all that a run needs to go on with the same bits, and its file: HDF5 behind the 512-byte user block,
// written under a temporary name, fsynced, renamed; the CRC is checked before libhdf5 sees the file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/state.h"

namespace scree {

std::uint32_t constexpr checkpoint_version = 1;

// The pair list outlives many steps, and histories follow its order. It is kept with the poses it was made at, so that
// the list is remade at the same step as without the stop. Node lists are remade at once: they decide what is looked
// at, never a bit of what comes out.
struct PairMemory {
  std::vector<Pair> pair;
  std::vector<Vec3> built_position;     // (n_solids); empty: the list is used up
  std::vector<Quat> built_orientation;  // ...
  std::vector<int> side;                // 2 pair + (0: nodes of a | 1: nodes of b) of each side of State::node_history
  // What the ledger and the watch read between steps (n_pairs).
  std::vector<double> energy_normal, energy_tangential, overlap;  // [J], [J], [m]
  std::vector<double> energy_rolling;                             // [J]; empty without rolling resistance
};

// How far the files of a run are, for what writes them.
struct OutputProgress {
  std::int64_t frames = 0;                              // written
  std::int64_t due = 0;                                 // the next one is due at due x every
  double every = 0;                                     // [s]
  std::int64_t measures_bytes = 0, contacts_bytes = 0;  // of measures.csv and contacts.csv
};

struct Checkpoint {
  std::string identity;      // case_identity()
  std::uint64_t inputs = 0;  // inputs_hash()
  State state;
  PairMemory pairs;
  bool at_rest = false;          // settle has ended the run
  bool warned_of_share = false;  // of the critical step, once a run
  OutputProgress output;
};

// Throws std::system_error naming the file when it cannot be written.
void write_checkpoint(std::filesystem::path const& file, Checkpoint const& checkpoint);
// Throws InputError: "<file>: what is wrong; way out".
Checkpoint read_checkpoint(std::filesystem::path const& file);

}  // namespace scree
