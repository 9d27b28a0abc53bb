// shape_source.h: what `scree-shape` takes a body from: a shape of a model file, a mesh, or a point cloud.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "shapes/phi_batch.h"
#include "shapes/point_files.h"
#include "shapes/surface_samples.h"
#include "shapes/triangle_mesh.h"
#include "shapes/zero_set.h"

namespace scree {

struct ShapeSource {
  std::string title;          // for people
  char const* unit = "unit";  // of lengths: "d" for models
  Vec3 centre;                // of the file's coordinates; everything below is relative to it
  PhiBatch phi;               // positive inside; empty for point clouds
  ZeroSetOptions domain;      // the ball that holds the surface
  double volume = 0;          // 0 for point clouds
  TriangleMesh mesh;          // meshes only: the surface itself
  PointCloud cloud;           // point clouds only

  bool is_cloud() const { return !phi; }
};

// `file`: .h5 (then `shape` names one of its shapes; it may be empty when there is only one), .stl, .obj, .ply with
// faces, .ply without faces or .xyz. Centres: the model's origin, the mesh's centroid, the mean of the points. Throws
// std::invalid_argument for what cannot be read, for meshes that bound no solid (the defect and the way out), and for a
// `shape` that is not there or where there are none.
ShapeSource open_source(std::filesystem::path const& file, std::string const& shape, int threads);

// `count` points of the surface with normals: of a mesh its own triangles' where they are even over the area, else by
// surface projection, which it reports on stdout. Not for clouds. Throws as sample_surface.
PointCloud surface_points(ShapeSource const& source, int count, SampleSpread spread);

// The surface as a fine mesh that other meshes are compared with: the mesh, or the refined zero set.
TriangleMesh truth_mesh(ShapeSource const& source);

// Back to the file's coordinates.
void move_by(TriangleMesh& mesh, Vec3 by);
void move_by(PointCloud& cloud, Vec3 by);

}  // namespace scree
