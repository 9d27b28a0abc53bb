// fuzz_stl.cpp: STL files, ASCII and binary.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/stl_file.h"
#include "tests/fuzz/mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  return scree::fuzz::run_mesh_reader(data, size, [](std::string const& b) { return scree::parse_stl("x.stl", b); });
}
