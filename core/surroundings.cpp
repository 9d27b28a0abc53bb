// surroundings.cpp: see surroundings.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/surroundings.h"

#include <algorithm>

namespace scree {

Box surroundings_of(Scene const& scene, State const& start) {
  if (scene.plane.empty() && scene.wall.empty()) return empty_box();
  Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  auto const include = [&](Vec3 at, double reach) {
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], at[k] - reach);
      box.max[k] = std::max(box.max[k], at[k] + reach);
    }
  };
  for (int i = 0; i < scene.bodies(); ++i)
    include(start.position[i], scene.shape[scene.shape_of[i]].bounding_radius * scene.diameter[i]);
  for (PlaneRecord const& plane : scene.plane) include(plane.point, 0);
  for (WallBody const& wall : scene.wall) include(wall.position, wall.reach);
  double const diagonal = norm(box.max - box.min);
  return {box.min - Vec3{1, 1, 1} * diagonal, box.max + Vec3{1, 1, 1} * diagonal};
}

int first_outside(Box const& surroundings, Scene const& scene, State const& state) {
  if (!(surroundings.min.x <= surroundings.max.x)) return -1;
  for (int i = 0; i < scene.bodies(); ++i) {
    if (!state.is_active(i)) continue;
    Vec3 const x = state.position[i];
    for (int k = 0; k < 3; ++k)
      if (x[k] < surroundings.min[k] || x[k] > surroundings.max[k]) return i;
  }
  return -1;
}

}  // namespace scree
