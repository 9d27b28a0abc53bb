// fuzz_checkpoint.cpp: the content of a checkpoint behind its CRC, edited; what a run accepts, it goes on from.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>

#include "core/checkpoint_content.h"
#include "core/simulation.h"
#include "tests/fuzz/hdf5_edits.h"
#include "tests/support/every_effect.h"

using namespace scree;

namespace {

// Grains with nodes and closed-form spheres, moving walls, insertion, deletion, measurements with a memory.
Case small_case() {
  Case c = scree::testing::spheres_in_a_drum();
  c.contact[0].damping_ratio.reset();  // its lookup takes a third of a second
  for (GrainsCase& g : c.grains) g.count = 2, g.insert.rate = 1000, g.nodes = 60;
  return c;
}

struct Run {
  Simulation simulation{small_case(), {}};
  Checkpoint good;
  Run() {
    for (int i = 0; i < 200; ++i) simulation.step();
    good = simulation.checkpoint();
  }
};
Run& sound_run() {
  static Run run;
  return run;
}

}  // namespace

// Seconds under sanitizers, which the first input must not be charged with.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  sound_run();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  static hdf5::QuietErrors const quiet;
  auto& [simulation, good] = sound_run();
  fuzz::FuzzInput in(data, size);
  fuzz::EditedFile const file([](hid_t at) { write_checkpoint_content(at, sound_run().good); }, in);
  try {
    simulation.restore(read_checkpoint_content(hdf5::open_file(file.name())));
    for (int i = 0; i < 3 && simulation.state() == RunState::running; ++i) simulation.step();
    simulation.measure_rows();
    simulation.frame();
    simulation.ledger();
  } catch (std::runtime_error const& error) {
    if (size == 0) std::fprintf(stderr, "%s\n", error.what());
    fuzz::must(size > 0, "a checkpoint that nobody edited is gone on from");
  }
  return 0;
}
