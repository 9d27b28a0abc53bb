// effect_stages.cpp: see effect_stages.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/effect_stages.h"

#include <limits>

#include "kernels/body_effects.h"

namespace scree {

void brake_bodies(Queue const& queue, Case const& c, Effects const& effects, SceneView const& view, double dt,
                  State& state) {
  if (effects.drag) {
    DragParameters const drag{c.drag->density, c.drag->coefficient, c.drag->fluid_velocity};
    apply_drag(queue, view, state.view(), drag, dt, state.removed_by_drag);
  }
  if (effects.global_damping)
    apply_global_damping(queue, "damping/bodies", view, state.view(), c.damping->rate, dt, state.removed_by_damping);
}

void push_bodies(Queue const& queue, Case const& c, Scene const& scene, double from, double to, Workspace& work) {
  work.group_force.assign(c.grains.size(), {});
  for (ForceCase const& f : c.force) {
    double const factor =
        f.table.empty() ? share_inside(f.start, f.stop.value_or(std::numeric_limits<double>::infinity()), from, to)
                        : mean_over(f.table, from, to);
    for (std::size_t g = 0; g < c.grains.size(); ++g)
      if (c.grains[g].name == f.grains) work.group_force[g] += Wrench{f.force * factor, f.torque * factor};
  }
  work.applied.resize(scene.bodies());
  apply_group_forces(queue, scene.view(), scene.group_of, work.group_force, work.applied);
}

}  // namespace scree
