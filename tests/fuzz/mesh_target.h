// mesh_target.h: what a mesh must be once a reader has accepted it, and what the engine does with it then.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "shapes/mesh_files.h"
#include "shapes/mesh_tree.h"
#include "tests/fuzz/fuzz_input.h"

namespace scree::fuzz {

inline void check_mesh(TriangleMesh const& mesh) {
  auto const n = static_cast<int>(mesh.vertex.size());
  for (Vec3 const& v : mesh.vertex) must(is_finite(v), "vertices are finite");
  for (auto const& t : mesh.triangle)
    for (int const corner : t) must(corner >= 0 && corner < n, "corners are vertices");
}

// Parses; a mesh that is accepted becomes a search tree that answers. Complaints are std::runtime_error.
inline int run_mesh_reader(std::uint8_t const* data, std::size_t size,
                           std::function<TriangleMesh(std::string const&)> const& parse) {
  try {
    TriangleMesh const mesh = weld(parse({reinterpret_cast<char const*>(data), size}));
    check_mesh(mesh);
    check_coordinates("x", mesh);
    if (mesh.triangle.empty()) return 0;
    MeshTree const tree(mesh);
    must(!std::isnan(mesh_distance(tree.sdf(), {0.3, -0.2, 0.1}, nullptr)), "a distance is a number");
  } catch (std::runtime_error const&) {
    // a complaint, as it should be
  }
  return 0;
}

}  // namespace scree::fuzz
