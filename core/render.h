// render.h: a picture of one frame of a run, drawn from the very phi that was simulated.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/png_file.h"
#include "core/render_colours.h"
#include "core/results.h"
#include "kernels/network_device.h"

namespace scree {

struct Camera {
  Vec3 eye, target;            // world [m]; the picture's vertical is world z
  double field_of_view = 0.5;  // vertical [rad]
};

// What lies in front of it, as its normal points, is cut away; grains show their inside there.
struct CutPlane {
  Vec3 point, normal;  // world [m], unit
};

struct RenderOptions {
  int width = 1280, height = 960;
  int threads = 1;                                // the picture does not depend on it
  std::shared_ptr<NetworkDevice> network_device;  // evaluates the networks; null: the host does. The same picture
  std::optional<Camera> camera;                   // absent: chosen so that the grains fill the picture
  double azimuth = -0.96;                         // of the chosen camera round world z, from +x [rad]
  double elevation = 0.46;                        // of the chosen camera above the horizon [rad]
  ColourBy colour = ColourBy::kind;
  double colour_limit = 0;      // of a scale: its upper end; 0: the largest value in the frame
  std::optional<CutPlane> cut;  // grains alone; walls are as they are
  bool smooth_edges = true;     // four samples where a pixel differs from its neighbours
};

int constexpr render_floor = -1;  // in Rendering::id: a wall that faces up
int constexpr render_sky = -2;

struct Rendering {
  Image image;
  std::vector<int> id;       // body, render_floor or render_sky at each pixel's centre; glass walls hide nothing
  std::vector<float> depth;  // distance from the eye along the pixel's ray [m]; infinity: sky
  Camera camera;             // the one used
  double colour_limit = 0;   // the one used, where the colours are a scale
};

// Sun with shadows, sky light with ambient occlusion, a colour for each kind of grain (shape name up to '/'). Walls
// that face up are the floor; the others are drawn as glass where they face the camera from behind the grains, and as
// their edges alone where they stand before them. Throws std::invalid_argument for impossible options or when frame
// and header disagree, DeviceError.
Rendering render(ResultsHeader const& header, Frame const& frame, RenderOptions const& options = {});

// Share of the bodies that show in at least `pixels` pixels: a picture's machine check.
double visible_share(Rendering const& rendering, int bodies, int pixels = 10);

}  // namespace scree
