// fuzz_model.cpp: the content of a model file behind its CRC: one of every kind of shape, edited.
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "shapes/model_content.h"
#include "tests/fuzz/hdf5_edits.h"
#include "tests/fuzz/library_target.h"
#include "tests/support/shape_kinds.h"

using namespace scree;

namespace {

Library every_kind() {
  Library all;
  for (char const* kind : {"superellipsoid", "coded_net", "harmonics", "mesh", "grid"}) {
    Library one = scree::testing::library_of_kind(kind);
    Shape s = one.shape.at(0);
    if (s.is_net()) all.net = one.net;
    if (!one.harmonics.empty()) all.harmonics = one.harmonics;
    if (!one.mesh.empty()) all.mesh = one.mesh;
    if (!one.grid.empty()) all.grid = one.grid;
    all.shape.push_back(s);
  }
  return all;
}

Library const& sound_library() {
  static Library const library = every_kind();
  return library;
}

}  // namespace

// Seconds under sanitizers, which the first input must not be charged with.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  sound_library();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  static hdf5::QuietErrors const quiet;
  fuzz::FuzzInput in(data, size);
  fuzz::EditedFile const file([](hid_t at) { write_model_content(at, sound_library()); }, in);
  try {
    Library const library = read_model_content(hdf5::open_file(file.name()));
    if (problems(library).empty())
      fuzz::check_library(library);
    else
      fuzz::must(size > 0, "a file that nobody edited is valid");
  } catch (std::exception const& error) {
    if (size == 0) std::fprintf(stderr, "%s\n", error.what());
    fuzz::must(size > 0, "a file that nobody edited is read");
  }
  return 0;
}
