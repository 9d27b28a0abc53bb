// render_stage.h: what a picture shows besides grains: floor, glass walls with their edges, and where the camera goes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/grain_rays.h"
#include "core/render.h"
#include "core/render_walls.h"

namespace scree {

// The walls of a run, cut off a little above the grains: the picture is of the grains.
class RenderStage {
 public:
  RenderStage(ResultsHeader const& header, RenderWalls const& walls, Box const& grains);

  double floor_distance(Ray const& ray) const;  // to the first wall that faces up; infinity: none
  Vec3 floor_normal(Vec3 point) const;          // of the floor that is nearest to the point
  // Height above the nearest floor [m]; infinity: there is none.
  double height(Vec3 point) const;
  // Share of the light that glass takes on the ray's way, up to `distance`.
  double glass(Ray const& ray, double distance) const;
  // How much of an edge of the glass covers the ray, 0..1; `pixel`: angle of one [rad].
  double edges(Ray const& ray, double distance, double pixel) const;

  // Grains, floor and the foot of the glass.
  Box const& shown() const { return shown_; }

 private:
  struct Panel {
    Vec3 point, normal;
    bool floor, drawn;  // the cut above the grains and the domain's sides are not drawn, they only bound the others
  };
  struct Edge {
    Vec3 from, to;
  };
  bool within(Vec3 point, std::size_t except, std::size_t except_too) const;
  void find_edges();

  std::vector<Panel> panels_;
  std::vector<Edge> edges_;
  Box shown_;
  double size_ = 1;
};

// Where the whole of `box` fills the picture, seen from the given direction.
Camera fitted_camera(Box const& box, RenderOptions const& options);

// Right, up and forward unit vectors of a camera.
struct CameraFrame {
  Vec3 right, up, forward;
  explicit CameraFrame(Camera const& camera);
};

}  // namespace scree
