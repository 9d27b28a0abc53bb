// wall_surface.h: the walls of a results file as triangles in a frame's poses, and their phi: for pictures, other
// programs and measurements.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "core/results.h"
#include "core/wall_motion.h"
#include "shapes/mesh_tree.h"

namespace scree {

int constexpr circle_segments = 128;  // chords of a round wall: 3e-4 of its radius within the circle

// Circle in z = 0, counter-clockwise about z, its corners on the circle.
std::vector<Vec3> circle(double radius);
// A convex polygon as triangles that turn as it does.
TriangleMesh fan(std::vector<Vec3> const& ring);
// The part of an endless plane that lies in the box, counter-clockwise about the normal; empty when they do not meet.
std::vector<Vec3> plane_in_box(Vec3 point, Vec3 normal, Box const& box);

// Surface of the solid in its own frame [m], counter-clockwise seen from the free space; a sheet by its middle. Empty
// for an endless plane.
TriangleMesh wall_surface(ResultsWallBody const& wall);

// Where wall body `index` of the header stands. Throws std::invalid_argument when the frame lacks poses of walls.
WallPose wall_pose(ResultsHeader const& header, Frame const& frame, int index);

// Plane `index` of the header in the world: the disc of a cylinder's end, or what lies in the domain.
std::vector<Vec3> plane_outline(ResultsHeader const& header, int index);
// The surface of wall body `index` in the world; an endless plane as far as it lies in the domain.
TriangleMesh posed_wall(ResultsHeader const& header, Frame const& frame, int index);

// phi of one wall body [m] at points of its own frame, as the engine had it; positive inside the solid. Keeps a
// reference to the body.
class WallPhi {
 public:
  explicit WallPhi(ResultsWallBody const& wall);
  double operator()(Vec3 point, Vec3* gradient = nullptr) const;

 private:
  ResultsWallBody const* wall_;
  std::unique_ptr<MeshTree> tree_;
};

}  // namespace scree
