// obj_file.h: Wavefront OBJ.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "shapes/triangle_mesh.h"

namespace scree {

// Vertices and faces of `text`, the content of `file`; polygons become fans. Throws std::runtime_error naming `file`
// and the line.
TriangleMesh parse_obj(std::filesystem::path const& file, std::string const& text);

// Coordinates keep every bit.
std::string obj_text(TriangleMesh const& mesh);

}  // namespace scree
