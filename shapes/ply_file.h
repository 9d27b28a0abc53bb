// ply_file.h: PLY, ASCII and binary little-endian: vertices, normals, faces.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "kernels/base/vec.h"

namespace scree {

struct PlyContent {
  std::vector<Vec3> vertex;
  std::vector<Vec3> normal;                  // of vertex; empty: the file has none
  std::vector<std::array<int, 3>> triangle;  // polygons as fans; empty: a point cloud
};

// `bytes` is the content of `file`. Needs an element "vertex" with x, y, z; takes nx, ny, nz and the lists
// vertex_indices or vertex_index of "face"; skips every other element and property. ASCII: a row a line.
// Throws std::runtime_error "<file>:<line>: ..." (binary: "<file>: <element> <row>: ...").
PlyContent parse_ply(std::filesystem::path const& file, std::string const& bytes);

// Binary little-endian: positions as double, normals (empty or one a vertex) as float; faces where there are any.
std::string ply_bytes(std::vector<Vec3> const& vertex, std::vector<Vec3> const& normal,
                      std::vector<std::array<int, 3>> const& triangle);

}  // namespace scree
