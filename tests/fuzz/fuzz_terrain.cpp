// fuzz_terrain.cpp: elevation grids (ESRI ASCII) and the ground below them.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/terrain_file.h"
#include "tests/fuzz/mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  return scree::fuzz::run_mesh_reader(
      data, size, [](std::string const& b) { return scree::terrain_ground(scree::parse_terrain("x.asc", b)); });
}
