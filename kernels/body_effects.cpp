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
    double const before = kinetic_energy(scene, state, i);
    state.velocity[i] *= keep;
    state.angular_momentum[i] *= keep;
    removed[i] += before - kinetic_energy(scene, state, i);
  }
};

}  // namespace

void apply_gravity(Queue const& queue, SceneView const& scene, Vec3 acceleration, Span<Wrench> external) {
  parallel_for(queue, "gravity/bodies", scene.bodies(), Gravity{scene, acceleration, external}, 1024);
}

void apply_global_damping(Queue const& queue, SceneView const& scene, StateView const& state, double rate, double dt,
                          Span<double> removed) {
  parallel_for(queue, "global_damping/bodies", scene.bodies(),
               GlobalDamping{scene, state, std::exp(-rate * dt), removed}, 512);
}

}  // namespace scree
