// fuzz_ply.cpp: PLY files, as meshes and as points with normals.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/ply_file.h"
#include "tests/fuzz/mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  return scree::fuzz::run_mesh_reader(data, size, [](std::string const& bytes) {
    scree::PlyContent const ply = scree::parse_ply("x.ply", bytes);
    scree::fuzz::must(ply.normal.empty() || ply.normal.size() == ply.vertex.size(), "each vertex has a normal or none");
    return scree::TriangleMesh{ply.vertex, ply.triangle};
  });
}
