// body_effects.cpp: see body_effects.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/body_effects.h"

#include "kernels/base/parallel.h"
#include "kernels/integrate.h"

namespace scree {
namespace {

struct Gravity {
  SceneView scene;
  Vec3 acceleration;
  Span<Wrench> external;

  SCREE_HD void operator()(int i) const { external[i].force += acceleration * scene.mass[i]; }
};

struct GlobalDamping {
  SceneView scene;
  StateView state;
  double keep;
  Span<double> removed;

  SCREE_HD void operator()(int i) const {
    if (!state.active(i)) return;
    double const before = kinetic_energy(scene, state, i);
    state.velocity[i] *= keep;
    state.angular_momentum[i] *= keep;
    removed[i] += before - kinetic_energy(scene, state, i);
  }
};

struct Drag {
  SceneView scene;
  StateView state;
  DragParameters drag;
  double dt;
  Span<double> removed;

  SCREE_HD void operator()(int i) const {
    if (!state.active(i)) return;
    double constexpr quarter_pi = 0.78539816339744831;
    double const m = scene.mass[i], d = scene.diameter[i];
    double const k = 0.5 * drag.density * drag.coefficient * quarter_pi * d * d / m;
    Vec3 const before = state.velocity[i], u = before - drag.fluid_velocity;
    Vec3 const after = drag.fluid_velocity + u / (1 + k * norm(u) * dt);
    state.velocity[i] = after;
    removed[i] += 0.5 * m * dot(before - after, before + after);
  }
};

struct GroupForce {
  Span<const int> group_of;
  Span<const Wrench> of_group;
  Span<Wrench> applied;

  SCREE_HD void operator()(int i) const { applied[i] = of_group[group_of[i]]; }
};

struct LeavingBody {
  StateView state;
  Span<const DeleteRegion> region;
  Span<int> leaving;

  SCREE_HD static bool contains(DeleteRegion const& r, Vec3 x) {
    if (r.plane) return dot(r.normal, x - r.point) < 0;
    bool const in = x.x >= r.box.min.x && x.x <= r.box.max.x && x.y >= r.box.min.y && x.y <= r.box.max.y &&
                    x.z >= r.box.min.z && x.z <= r.box.max.z;
    return in == r.inside;
  }

  SCREE_HD void operator()(int i) const {
    leaving[i] = -1;
    // What is not finite is the watch's to find, not a way out.
    if (!state.active(i) || !is_finite(state.position[i])) return;
    for (int k = 0; k < region.size() && leaving[i] < 0; ++k)
      if (contains(region[k], state.position[i])) leaving[i] = k;
  }
};

}  // namespace

void apply_gravity(Queue const& queue, SceneView const& scene, Vec3 acceleration, Span<Wrench> external) {
  parallel_for(queue, "gravity/bodies", scene.bodies(), Gravity{scene, acceleration, external}, 1024);
}

void apply_global_damping(Queue const& queue, char const* name, SceneView const& scene, StateView const& state,
                          double rate, double dt, Span<double> removed) {
  parallel_for(queue, name, scene.bodies(), GlobalDamping{scene, state, std::exp(-rate * dt), removed}, 512);
}

void apply_drag(Queue const& queue, SceneView const& scene, StateView const& state, DragParameters const& drag,
                double dt, Span<double> removed) {
  parallel_for(queue, "drag/bodies", scene.bodies(), Drag{scene, state, drag, dt, removed}, 1024);
}

void apply_group_forces(Queue const& queue, SceneView const& scene, Span<const int> group_of,
                        Span<const Wrench> of_group, Span<Wrench> applied) {
  parallel_for(queue, "force/bodies", scene.bodies(), GroupForce{group_of, of_group, applied}, 1024);
}

void find_leaving(Queue const& queue, SceneView const& scene, StateView const& state, Span<const DeleteRegion> region,
                  Span<int> leaving) {
  parallel_for(queue, "delete/find", scene.bodies(), LeavingBody{state, region, leaving}, 1024);
}

}  // namespace scree
