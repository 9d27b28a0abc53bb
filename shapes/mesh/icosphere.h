// icosphere.h: the unit sphere as a subdivided icosahedron, the parameter mesh of smooth procedural bodies.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/triangle_mesh.h"

namespace scree {

// 20 * 4^subdivisions triangles (0..8), vertices on the unit sphere, outwards. std::invalid_argument outside 0..8.
TriangleMesh icosphere(int subdivisions);

}  // namespace scree
