// measure_walls.cpp: see measure_walls.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_walls.h"

#include "core/wall_motion.h"

namespace scree {
namespace {

int wall_index(Case const& c, std::string const& name) {
  for (std::size_t w = 0; w < c.wall.size(); ++w)
    if (c.wall[w].name == name) return static_cast<int>(w);
  return -1;
}

Wrench of_body(MeasureView const& view, int body, Vec3 through) {
  BodyWrenches const& all = view.state.wrench;
  Wrench sum;
  for (auto const* part : {&all.elastic, &all.damping, &all.friction}) sum += (*part)[body];
  if (!all.rolling.empty()) sum.torque += all.rolling[body];
  sum.torque += cross(view.state.position[body] - through, sum.force);
  return sum;
}

// Planes at rest have no wrench of their own: minus what acts on the grains that touch them.
Wrench of_planes(MeasureView const& view, int wall, Vec3 through) {
  Wrench sum;
  for (std::size_t k = 0; k < view.work.pair.size(); ++k) {
    Pair const p = view.work.pair[k];
    if (!p.with_plane() || view.scene.plane[p.plane()].wall != wall) continue;
    PairResult const& r = view.work.result[k];
    if (r.active == 0) continue;
    for (PairWrench const* part : {&r.elastic, &r.damping, &r.friction})
      sum += Wrench{-part->force_on_a, -(part->torque_a + cross(view.state.position[p.a] - through, part->force_on_a))};
    if (!view.work.rolling.empty()) sum.torque -= view.work.rolling[k].torque_on_a;
  }
  return sum;
}

}  // namespace

WallCase const* wall_named(Case const& c, std::string const& name) {
  int const w = wall_index(c, name);
  return w < 0 ? nullptr : &c.wall[w];
}

Vec3 axis_of(Case const& c, MeasureCase const& m) {
  if (m.axis) return *m.axis;
  WallCase const* const wall = wall_named(c, m.wall);
  return wall && wall->motion ? wall->motion->axis : Vec3{0, 0, 1};
}

Vec3 through_of(Case const& c, MeasureCase const& m) {
  if (m.through) return *m.through;
  WallCase const* const wall = wall_named(c, m.wall);
  return wall && wall->motion ? wall->motion->through : Vec3{};
}

double rate_of(MeasureView const& view) {
  WallCase const* const wall = wall_named(view.c, view.measure.wall);
  if (!wall || !wall->motion || wall->motion->kind != MotionKind::rotation) return 0;
  int const index = wall_index(view.c, view.measure.wall);
  for (std::size_t w = 0; w < view.scene.wall.size(); ++w)
    if (view.scene.wall[w].wall == index)  // a wall's angular momentum holds its spin, see kernels/views.h
      return dot(view.state.angular_momentum[view.scene.bodies() + w], normalized(axis_of(view.c, view.measure)));
  return 0;
}

std::string check_axis(Case const& c, MeasureCase const& m) {
  WallCase const* const wall = wall_named(c, m.wall);
  bool const turns = wall && wall->motion && wall->motion->kind == MotionKind::rotation;
  if (!turns && (!m.axis || !m.through)) return "needs axis and through, or the name of a wall that rotates";
  return "";
}

Wrench wrench_on_wall(MeasureView const& view, Vec3 through) {
  int const wall = wall_index(view.c, view.measure.wall);
  Wrench sum = of_planes(view, wall, through);
  for (std::size_t w = 0; w < view.scene.wall.size(); ++w)
    if (view.scene.wall[w].wall == wall) sum += of_body(view, view.scene.bodies() + static_cast<int>(w), through);
  return sum;
}

std::string check_torque(Case const& c, MeasureCase const& m) { return check_axis(c, m); }

std::vector<Quantity> torque_quantities(MeasureView const&) {
  return {{"torque", "N m"}, {"power", "W"}, {"work", "J"}};
}

// memory: seconds, torque x seconds, power x seconds since the last sample; work before it.
void visit_torque(MeasureView const& view, double dt, Memory& memory) {
  memory.resize(4, 0);
  Vec3 const axis = normalized(axis_of(view.c, view.measure));
  double const torque = -dot(axis, wrench_on_wall(view, through_of(view.c, view.measure)).torque);
  memory[0] += dt;
  memory[1] += torque * dt;
  memory[2] += torque * rate_of(view) * dt;
}

Values sample_torque(MeasureView const&, Memory& memory) {
  double const seconds = memory[0];
  memory[3] += memory[2];
  Values const out{memory[1] / seconds, memory[2] / seconds, memory[3]};
  memory[0] = memory[1] = memory[2] = 0;
  return out;
}

std::vector<Quantity> wall_force_quantities(MeasureView const&) {
  return {{"x", "N"}, {"y", "N"}, {"z", "N"}, {"size", "N"}};
}

void visit_wall_force(MeasureView const& view, double dt, Memory& memory) {
  memory.resize(4, 0);
  Vec3 const force = wrench_on_wall(view, {}).force;
  memory[0] += dt;
  for (int k = 0; k < 3; ++k) memory[1 + k] += force[k] * dt;
}

Values sample_wall_force(MeasureView const&, Memory& memory) {
  Vec3 const mean = Vec3{memory[1], memory[2], memory[3]} / memory[0];
  memory.assign(4, 0);
  return {mean.x, mean.y, mean.z, norm(mean)};
}

}  // namespace scree
