// render_walls.h: walls of any surface in a picture: opaque ones stop rays, glass ones tint them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/grain_rays.h"
#include "shapes/mesh_tree.h"

namespace scree {

class RenderWalls {
 public:
  // Where the frame has them. Throws as wall_pose does.
  RenderWalls(ResultsHeader const& header, Frame const& frame);

  struct Hit {
    double distance = 0;  // [m]
    Vec3 normal;          // unit, towards the ray's origin; smooth where the surface is
  };
  // First opaque wall nearer than `limit`.
  std::optional<Hit> first(Ray const& ray, double limit) const;
  // Share of the light that glass walls take up to `distance`.
  double glass(Ray const& ray, double distance) const;
  // Sharp edges and borders.
  struct Edge {
    Vec3 from, to;
  };
  std::vector<Edge> const& edges() const { return edges_; }
  // Of all walls; nothing without walls.
  std::optional<Box> const& bounds() const { return bounds_; }

 private:
  struct Wall {
    MeshTree tree;
    bool glass;
  };
  std::vector<Wall> walls_;
  std::vector<Edge> edges_;
  std::optional<Box> bounds_;
};

}  // namespace scree
