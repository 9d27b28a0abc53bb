// bounds.cpp: see bounds.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/bounds.h"

#include "kernels/base/parallel.h"

namespace scree {
namespace {

struct BoundsOfBody {
  SceneView scene;
  StateView state;
  Span<const double> skin;
  Span<Box> box;

  SCREE_HD void operator()(int i) const {
    if (!state.active(i)) {
      box[i] = empty_box();
      return;
    }
    Box const& local = scene.shape_record(i).box;
    double const d = scene.diameter[i];
    Mat3 const rotation = to_matrix(state.orientation[i]);
    Vec3 const centre = state.position[i] + rotation * ((local.min + local.max) * (0.5 * d));
    Vec3 const half = (local.max - local.min) * (0.5 * d);
    Vec3 extent;
    for (int k = 0; k < 3; ++k)
      extent[k] = std::fabs(rotation.row[k].x) * half.x + std::fabs(rotation.row[k].y) * half.y +
                  std::fabs(rotation.row[k].z) * half.z + skin[i];
    box[i] = {centre - extent, centre + extent};
  }
};

}  // namespace

void compute_bounds(Queue const& queue, SceneView const& scene, StateView const& state, Span<const double> skin,
                    Span<Box> box) {
  parallel_for(queue, "bounds/boxes", scene.solids(), BoundsOfBody{scene, state, skin, box}, 512);
}

}  // namespace scree
