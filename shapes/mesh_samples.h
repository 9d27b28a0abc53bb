// mesh_samples.h: points spread evenly over the area of a triangle mesh.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "shapes/point_files.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// `count` points on the triangles with the triangles' normals, no two nearer than about 0.6 of the spacing of a
// hexagonal lattice of as many: dart throwing with a shrinking radius (McCool and Fiume 1992) among six times as many
// points uniform over the area. Distances are straight ones. Deterministic in `seed`. Throws std::invalid_argument when
// the mesh has no area or count < 1.
PointCloud sample_mesh(TriangleMesh const& mesh, int count, std::uint64_t seed = 1);

}  // namespace scree
