// paraview.h: a run for ParaView: scene.pvd (surfaces of all grains, walls) and grains.pvd (a point a grain).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "core/results.h"

namespace scree {

// kind of each body: numbers of the parts of the shapes' names before the first '/' or ':' in order of appearance:
// ballast/0 and ballast/1 share one.
std::vector<std::int32_t> kind_of_bodies(ResultsHeader const& header);

struct ParaviewOptions {
  int triangles = 600;          // largest number of triangles a grain
  double surface_budget = 3e8;  // uncompressed bytes of all surface files; with more frames, every k-th has surfaces
  int frames_expected = 100;    // what the budget is divided by
};

// Files of `folder`: scene.pvd, grains.pvd, walls.vtp, frames/surfaces_<k>.vtp (first, every k-th and last frame),
// frames/grains_<k>.vtp (every frame); with moving walls frames/walls_<k>.vtp beside the surfaces. The collections are
// rewritten with every frame: a killed run opens. surfaces: cells carry body, shape, kind, material, group, replica,
// velocity [m/s]; coordinates are float [m]. grains: points carry these and spin [rad/s], orientation (w, x, y, z),
// diameter [m]. walls: cells carry the number of the wall among the header's planes and, after them, its wall bodies.
class ParaviewWriter {
 public:
  // Makes the folder and meshes every shape's zero set. Throws std::system_error naming what cannot be written.
  ParaviewWriter(std::filesystem::path const& folder, ResultsHeader const& header, ParaviewOptions const& options = {});
  ~ParaviewWriter();
  void write_frame(Frame const& frame);
  void finish();  // surfaces of the last frame, if it has none

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace scree
