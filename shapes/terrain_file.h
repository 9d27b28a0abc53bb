// terrain_file.h: elevation grids in the ESRI ASCII format as triangle meshes, and the ground below them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "shapes/triangle_mesh.h"

namespace scree {

// Every value is a vertex in the middle of its cell; x and y count from the lower left corner of the grid (its place on
// the map, often millions of metres, would cost digits), z is the elevation, all in the file's unit. Four neighbours
// make two triangles that face up, cut along the diagonal that is nearer to level; cells without data (NODATA_value)
// leave holes. Throws std::runtime_error "<file>:<line>: ..." for anything that is not such a grid, and for one without
// a whole cell.
TriangleMesh read_terrain(std::filesystem::path const& file);
// The same of a file's text; `file` is for messages.
TriangleMesh parse_terrain(std::filesystem::path const& file, std::string const& text);

// The ground: everything straight below the surface, and nothing beside it. Appends vertical triangles that hang from
// every border, holes included, as deep below the lowest vertex as the footprint is wide; MeshTree with
// MeshBorder::open then has the ground's signed distance, which is continuous wherever a grain can be. (Without them
// phi would jump from the depth to nothing where a point below the surface crosses the border.) Empty stays empty.
TriangleMesh terrain_ground(TriangleMesh surface);
// Whether a triangle of a ground hangs from its border: two of its corners lie one above the other.
bool is_terrain_side(Vec3 a, Vec3 b, Vec3 c);

}  // namespace scree
