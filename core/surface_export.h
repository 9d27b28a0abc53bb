// surface_export.h: the grains of one frame as triangle meshes in world coordinates, for other programs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/results.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// The mesh of every body, in the order of the bodies [m]: light_mesh of its shape with at most `triangles` faces (more
// for bodies that are not star-shaped), scaled, turned and moved. Throws as light_mesh does.
std::vector<TriangleMesh> grain_meshes(ResultsHeader const& header, Frame const& frame, int triangles);

// Planes as far as they lie in the domain, then wall bodies where they are at the frame's time, in the header's order
// [m]; walls outside the domain are empty. Triangles face the free space. Throws as wall_pose does.
std::vector<TriangleMesh> wall_meshes(ResultsHeader const& header, Frame const& frame);

// All of them in one; touching grains keep their own vertices.
TriangleMesh joined(std::vector<TriangleMesh> const& meshes);

}  // namespace scree
