// bits_entries.cpp: 1, 2 and 4 threads, the same run twice, a stop and a restart in the middle: the same bits.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/checkpoint.h"
#include "tests/hard/course.h"
#include "tests/support/every_effect.h"
#include "tests/support/same_state.h"

namespace scree::book {
namespace {

using namespace testing;

TEST(Hard, TheSameBits) {
  Entry book("hard", "bits", "threads, repetition and restart give the same bits", "hash of every member of the state");
  std::filesystem::path const folder =
      std::filesystem::temp_directory_path() / ("scree_bits_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::pair<char const*, Case> scenes[] = {{"networks on a wedge", networks_on_a_wedge(folder)},
                                           {"spheres in a drum", spheres_in_a_drum()},
                                           {"lattice of all kinds", lattice_of_all_kinds(folder)}};
  for (auto& [name, c] : scenes) {
    if (!full()) c.time.end = 0.09;
    Simulation first(c, {.threads = 1});
    follow(first);
    std::string const reference = std::to_string(hash_of(first.impl().state));
    int differ = 0, runs = 0;
    for (int threads : {1, 2, 4}) {
      Simulation again(c, {.threads = threads});
      follow(again);
      differ += differences(first.impl().state, again.impl().state) != "", ++runs;
    }
    Simulation half(c, {.threads = 2});
    while (half.steps() < first.steps() / 2) half.step();
    write_checkpoint(folder / "half.h5", half.checkpoint());
    for (int threads : {1, 4}) {
      Simulation rest(c, {.threads = threads});
      rest.restore(read_checkpoint(folder / "half.h5"));
      follow(rest);
      differ += differences(first.impl().state, rest.impl().state) != "", ++runs;
    }
    book.at_most(std::string(name) + ": runs with other bits, of " + std::to_string(runs), "", differ, 0);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace scree::book
