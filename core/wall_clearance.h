// wall_clearance.h: whether a sphere or a point is clear of all walls, for finding and judging places of grains.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene.h"

namespace scree {

// phi of wall body `wall` of the scene at a point of its own frame [m]; positive inside the wall's solid.
double wall_phi(Scene const& scene, int wall, Vec3 point);

class WallClearance {
 public:
  // Walls where they stand at time 0; with poses of all solids (n_solids), where those say. Keeps references.
  explicit WallClearance(Scene const& scene) : scene_(scene) {}
  WallClearance(Scene const& scene, std::vector<Vec3> const& position, std::vector<Quat> const& orientation)
      : scene_(scene), position_(&position), orientation_(&orientation) {}

  bool is_clear(Vec3 centre, double radius) const;
  // Wall of the case whose solid holds the point; -1: none does.
  int wall_around(Vec3 point) const;

 private:
  double phi(int wall, Vec3 point) const;  // of a wall body [m]

  Scene const& scene_;
  std::vector<Vec3> const* position_ = nullptr;
  std::vector<Quat> const* orientation_ = nullptr;
};

}  // namespace scree
