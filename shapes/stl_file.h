// stl_file.h: STL, binary and ASCII.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "shapes/triangle_mesh.h"

namespace scree {

// The facets in `bytes`, the content of `file`, three vertices each (a soup). Throws std::runtime_error naming `file`
// and the line (ASCII) or facet (binary).
TriangleMesh parse_stl(std::filesystem::path const& file, std::string const& bytes);

// Binary; coordinates become floats.
std::string stl_bytes(TriangleMesh const& mesh);

}  // namespace scree
