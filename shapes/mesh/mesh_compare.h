// mesh_compare.h: how far two closed meshes are apart: Hausdorff distance and volume.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/triangle_mesh.h"

namespace scree {

struct MeshDifference {
  double hausdorff = 0;     // the larger of the two below [unit]
  double from_mesh = 0;     // farthest that a point of the mesh is from the truth [unit]
  double from_truth = 0;    // farthest that a point of the truth is from the mesh [unit]
  double mean = 0;          // of all those distances, both ways [unit]
  double volume_error = 0;  // relative to the truth's volume
};

// `samples` points spread over the area of each mesh, and as many of its vertices (all if it has fewer), against the
// other's surface. The distances are exact, their maximum a lower bound of the true one. Both meshes must bound a
// solid: std::invalid_argument. About 30 us a point for 20,000 triangles.
MeshDifference compare_meshes(TriangleMesh const& mesh, TriangleMesh const& truth, int samples = 10000,
                              int threads = 1);

}  // namespace scree
