// mesh_files.h: triangle meshes from and to STL (binary, ASCII), OBJ and PLY (binary, ASCII) files.
// Only geometry: normals, colours, materials and groups are skipped. Polygons are cut into fans.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "shapes/triangle_mesh.h"

namespace scree {

// Read by extension (.stl, .obj, .ply, any case). Vertices with the same coordinates become one, and triangles that use
// a vertex twice are dropped. Unit: the file's. Throws std::runtime_error "<file>:<line>: ..." (binary: "<file>: facet
// <n>: ...") for anything unreadable, non-finite, out of range, or a length that is not what the header promises.
TriangleMesh read_mesh(std::filesystem::path const& file);

// Of a mesh in a MeshTree: areas and their squares stay far from the end of a double's range.
double constexpr largest_coordinate = 1e60;
// Throws std::runtime_error naming the file for a coordinate beyond it.
void check_coordinates(std::filesystem::path const& file, TriangleMesh const& mesh);

// Write by extension: .stl (binary), .obj or .ply (binary). Throws std::runtime_error naming the file.
void write_mesh(std::filesystem::path const& file, TriangleMesh const& mesh);

// The extension is one of these three.
bool is_mesh_file(std::filesystem::path const& file);

// Merge vertices with identical coordinates and drop triangles that then use a vertex twice.
TriangleMesh weld(TriangleMesh const& soup);

}  // namespace scree
