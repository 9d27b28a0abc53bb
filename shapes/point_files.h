// point_files.h: point clouds, with or without normals, from and to PLY and XYZ files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "kernels/base/vec.h"

namespace scree {

struct PointCloud {
  std::vector<Vec3> position;  // [unit of the file]
  std::vector<Vec3> normal;    // outward unit; empty: not known
};

// .ply: the vertices of any PLY file. .xyz: a point a line, three numbers or six (the last three a unit normal), the
// same count in every line. Normals are scaled to length 1. Throws std::runtime_error as read_mesh does.
PointCloud read_points(std::filesystem::path const& file);

// .ply (binary) or .xyz, the latter with every bit. Throws std::runtime_error naming the file.
void write_points(std::filesystem::path const& file, PointCloud const& cloud);

// An .xyz file, or a .ply file whose header promises no faces. Throws std::runtime_error if that cannot be read.
bool holds_points(std::filesystem::path const& file);

}  // namespace scree
