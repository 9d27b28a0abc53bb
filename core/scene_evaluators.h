// scene_evaluators.h: what answers for phi of each template: networks, radii, grids and meshes as kernels see them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "core/scene.h"

namespace scree {

// What a network's box grows by: it is that of a triangulated zero set, whose chords lie inside [d].
double constexpr box_slack = 2e-3;

// Record of a shape without nodes and without what answers for its phi.
ShapeRecord record_of(Shape const& shape);

// Fills Scene::networks, the arrays behind SdfDataView and the parts of Scene::library. What several templates share
// (a decoder, a mesh, a baked grid) is stored once.
class SceneEvaluators {
 public:
  // Both must outlive this.
  SceneEvaluators(std::vector<Library> const& libraries, Scene& scene, int threads)
      : libraries_(libraries), scene_(scene), threads_(threads) {}

  // Kernel record (without nodes) of shape `shape` of library `library`, evaluated as `kind`; `cells` > 0: baked with
  // so many cells across its bounding diameter, through the cache (notes go to Scene::notes). `out`, a copy of the
  // shape, receives the phi that is simulated: kind, indices into Scene::library, bounds. Throws what baking throws.
  ShapeRecord add(int library, int shape, ShapeKind kind, int cells, Shape& out);

 private:
  struct MeshPlace {
    int first_node, first_triangle;
  };
  int place_net(int library, int net);
  int place_harmonics(int library, int data);
  int place_mesh(std::shared_ptr<MeshTree const> const& mesh);
  int place_grid(std::shared_ptr<SdfGrid const> const& grid);
  Library const& baked(int library, int shape, ShapeKind kind, int cells);

  std::vector<Library> const& libraries_;
  Scene& scene_;
  int threads_;
  std::map<std::pair<int, int>, int> net_, harmonics_;             // (library, index there) -> index in the scene
  std::map<std::tuple<int, int, ShapeKind, int>, Library> baked_;  // by the arguments of baked()
  std::vector<int> first_coefficient_;                             // of Scene::library.harmonics
  std::vector<MeshPlace> mesh_place_;                              // of Scene::library.mesh
  std::vector<std::size_t> first_value_;                           // of Scene::library.grid
};

}  // namespace scree
