// integrate.cpp: see integrate.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/integrate.h"

#include "kernels/base/parallel.h"

namespace scree {
namespace {

// Kick, and account for the work of the dissipative forces at the half-step velocity.
SCREE_HD void half_kick(SceneView const& scene, StateView const& state, WrenchesView const& w, double dt, int i,
                        Vec3& velocity, Vec3& angular_momentum) {
  Wrench total = w.elastic[i];
  total += w.damping[i];
  total += w.friction[i];
  total += w.external[i];
  if (!w.applied.empty()) total += w.applied[i];
  if (!w.rolling.empty()) total.torque += w.rolling[i];
  velocity = state.velocity[i] + total.force * (0.5 * dt / scene.mass[i]);
  angular_momentum = state.angular_momentum[i] + total.torque * (0.5 * dt);
}

SCREE_HD void account(SceneView const& scene, StateView const& state, WrenchesView const& w, double dt, int i,
                      Vec3 half_velocity, Vec3 half_angular_momentum, WorkView const& work) {
  Vec3 const spin = spin_of(state.orientation[i], scene.inertia[i], half_angular_momentum);
  work.damping[i] += 0.5 * dt * (dot(w.damping[i].force, half_velocity) + dot(w.damping[i].torque, spin));
  work.friction[i] += 0.5 * dt * (dot(w.friction[i].force, half_velocity) + dot(w.friction[i].torque, spin));
  if (!w.applied.empty())
    work.applied[i] += 0.5 * dt * (dot(w.applied[i].force, half_velocity) + dot(w.applied[i].torque, spin));
  if (!w.rolling.empty()) work.rolling[i] += 0.5 * dt * dot(w.rolling[i], spin);
}

// Walls go where they are told; what the grains' forces do on them is the work of the drive, with the other sign.
struct WorkOfWall {
  SceneView scene;
  StateView state;
  WrenchesView wrenches;
  double dt;
  WorkView work;

  SCREE_HD static double power(Wrench const& w, Vec3 velocity, Vec3 spin) {
    return dot(w.force, velocity) + dot(w.torque, spin);
  }
  SCREE_HD void operator()(int wall) const {
    int const i = scene.bodies() + wall;
    Vec3 const v = state.velocity[i], spin = state.angular_momentum[i];
    double const damping = 0.5 * dt * power(wrenches.damping[i], v, spin);
    double const friction = 0.5 * dt * power(wrenches.friction[i], v, spin);
    work.damping[i] += damping;
    work.friction[i] += friction;
    double const rolling = wrenches.rolling.empty() ? 0 : 0.5 * dt * dot(wrenches.rolling[i], spin);
    if (!wrenches.rolling.empty()) work.rolling[i] += rolling;
    work.wall[wall] -= damping + friction + rolling + 0.5 * dt * power(wrenches.elastic[i], v, spin);
  }
};

struct OpenStep {
  SceneView scene;
  StateView state;
  WrenchesView wrenches;
  double dt;
  WorkView work;

  SCREE_HD void operator()(int i) const {
    if (!state.active(i)) return;
    Vec3 v, l;
    half_kick(scene, state, wrenches, dt, i, v, l);
    account(scene, state, wrenches, dt, i, v, l, work);
    state.velocity[i] = v;
    state.angular_momentum[i] = l;
    state.position[i] += v * dt;
    state.orientation[i] = rotate_free(state.orientation[i], scene.inertia[i], l, dt);
  }
};

struct CloseStep {
  SceneView scene;
  StateView state;
  WrenchesView wrenches;
  double dt;
  WorkView work;

  SCREE_HD void operator()(int i) const {
    if (!state.active(i)) return;
    account(scene, state, wrenches, dt, i, state.velocity[i], state.angular_momentum[i], work);
    Vec3 v, l;
    half_kick(scene, state, wrenches, dt, i, v, l);
    state.velocity[i] = v;
    state.angular_momentum[i] = l;
  }
};

}  // namespace

void open_step(Queue const& queue, SceneView const& scene, StateView const& state, WrenchesView const& wrenches,
               double dt, WorkView const& work) {
  parallel_for(queue, "integrate/walls", scene.walls, WorkOfWall{scene, state, wrenches, dt, work}, 64);
  parallel_for(queue, "integrate/open", scene.bodies(), OpenStep{scene, state, wrenches, dt, work}, 256);
}

void close_step(Queue const& queue, SceneView const& scene, StateView const& state, WrenchesView const& wrenches,
                double dt, WorkView const& work) {
  parallel_for(queue, "integrate/walls", scene.walls, WorkOfWall{scene, state, wrenches, dt, work}, 64);
  parallel_for(queue, "integrate/close", scene.bodies(), CloseStep{scene, state, wrenches, dt, work}, 256);
}

}  // namespace scree
