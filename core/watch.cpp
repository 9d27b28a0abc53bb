// watch.cpp: see watch.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/watch.h"

#include <algorithm>
#include <cmath>

#include "kernels/base/parallel.h"

namespace scree {
namespace {

struct KineticOfBody {
  SceneView scene;
  StateView state;
  Span<double> kinetic;

  SCREE_HD void operator()(int i) const { kinetic[i] = state.active(i) ? kinetic_energy(scene, state, i) : 0; }
};

}  // namespace

WatchReport watch(Queue const& queue, Scene const& scene, State& state, double g, Workspace& work) {
  WatchReport report;
  int const n = scene.bodies();
  work.kinetic.resize(n);
  parallel_for(queue, "watch/kinetic", n, KineticOfBody{scene.view(), state.view(), work.kinetic}, 512);
  ScopedTimer const timer(queue.profile, "watch/reduce", n);
  for (int i = 0; i < n; ++i) {
    if (report.not_finite < 0 && !(std::isfinite(work.kinetic[i]) && is_finite(state.position[i])))
      report.not_finite = i;
    report.kinetic_total += work.kinetic[i];
    report.kinetic_largest =
        std::max(report.kinetic_largest, work.kinetic[i] / (scene.mass[i] * g * scene.diameter[i]));
  }
  for (std::size_t k = 0; k < work.pair.size(); ++k) {
    if (!work.in_contact[k]) continue;
    Pair const p = work.pair[k];
    bool const wall = p.with_plane() || p.b >= n;
    double const d = wall ? scene.diameter[p.a] : std::min(scene.diameter[p.a], scene.diameter[p.b]);
    if (work.result[k].overlap > report.overlap * d)
      report.overlap = work.result[k].overlap / d, report.overlap_pair = static_cast<int>(k);
    if (work.result[k].depth > report.depth)
      report.depth = work.result[k].depth, report.depth_pair = static_cast<int>(k);
  }
  return report;
}

std::string describe_body(Scene const& scene, int body) {
  return "grain " + std::to_string(body) + " (" + scene.template_shape(scene.shape_of[body]).name + ")";
}

std::string describe_pair(Scene const& scene, Case const& c, Pair pair) {
  bool const wall = pair.with_plane() || pair.b >= scene.bodies();
  if (!wall) return describe_body(scene, pair.a) + " and " + describe_body(scene, pair.b);
  int const index = pair.with_plane() ? scene.plane[pair.plane()].wall : scene.wall[pair.b - scene.bodies()].wall;
  return describe_body(scene, pair.a) + " and wall '" + c.wall[index].name + "'";
}

}  // namespace scree
