// thread_entries.cpp: row 17 of the book: a nut turns down a bolt by its own weight, both meshes with a thread.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/simulation_impl.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_normalise.h"
#include "tests/support/cases.h"
#include "tests/support/scratch_folder.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr pitch = 0.06, mean_radius = 0.02, depth = 0.004, clearance = 0.0002;  // [m]
double constexpr nut_radius = 0.04, nut_height = 0.06, gravity = 9.81;                 // [m], [m/s2]

// A right-handed thread with one start: its crest climbs a pitch a turn.
double thread(double angle, double z) { return depth / 2 * std::cos(angle - 2 * M_PI * z / pitch); }

// Rings of points about the z axis, each point at the radius and height that `profile` gives for its angle and ring.
// `closed`: the last ring joins the first; else both ends are capped at the axis.
struct RadiusHeight {
  double radius, z;
};
TriangleMesh rings_of(int around, int rings, bool closed, std::function<RadiusHeight(double, int)> const& profile) {
  TriangleMesh m;
  for (int k = 0; k < rings; ++k)
    for (int i = 0; i < around; ++i) {
      double const angle = 2 * M_PI * i / around;
      RadiusHeight const p = profile(angle, k);
      m.vertex.push_back({p.radius * std::cos(angle), p.radius * std::sin(angle), p.z});
    }
  auto const at = [&](int k, int i) { return (k % rings) * around + i % around; };
  for (int k = 0; k + (closed ? 0 : 1) < rings; ++k)
    for (int i = 0; i < around; ++i) {
      m.triangle.push_back({at(k, i), at(k, i + 1), at(k + 1, i + 1)});
      m.triangle.push_back({at(k, i), at(k + 1, i + 1), at(k + 1, i)});
    }
  if (!closed)
    for (int end : {0, rings - 1}) {
      int const tip = static_cast<int>(m.vertex.size());
      m.vertex.push_back({0, 0, m.vertex[at(end, 0)].z});
      for (int i = 0; i < around; ++i) {
        if (end == 0)
          m.triangle.push_back({tip, at(end, i + 1), at(end, i)});
        else
          m.triangle.push_back({tip, at(end, i), at(end, i + 1)});
      }
    }
  return m;
}

// Unit quaternion of a rotation matrix: its largest component first, the others follow (Shepperd 1978).
Quat quat_of(Mat3 const& m) {
  auto const& [x, y, z] = m.row;
  double const square[4] = {1 + x.x + y.y + z.z, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z, 1 - x.x - y.y + z.z};
  switch (std::max_element(square, square + 4) - square) {
    case 0:
      return normalized(Quat{square[0], z.y - y.z, x.z - z.x, y.x - x.y});
    case 1:
      return normalized(Quat{z.y - y.z, square[1], x.y + y.x, x.z + z.x});
    case 2:
      return normalized(Quat{x.z - z.x, x.y + y.x, square[2], y.z + z.y});
    default:
      return normalized(Quat{y.x - x.y, x.z + z.x, y.z + z.y, square[3]});
  }
}

TriangleMesh bolt(double low, double high) {
  int const rings = 1 + static_cast<int>(std::lround((high - low) / pitch * 32));
  return rings_of(64, rings, false, [&](double angle, int k) {
    double const z = low + (high - low) * k / (rings - 1);
    return RadiusHeight{mean_radius + thread(angle, z), z};
  });
}

// Up along the outside, down along the thread.
TriangleMesh nut() {
  int const rings = 33;
  return rings_of(64, 2 + rings, true, [&](double angle, int k) {
    double const half = nut_height / 2;
    if (k < 2) return RadiusHeight{nut_radius, k == 0 ? -half : half};
    double const z = half - nut_height * (k - 2) / (rings - 1);
    return RadiusHeight{mean_radius + clearance + thread(angle, z), z};
  });
}

// Without friction all weight goes into the screw motion: v = w p / (2 pi), a = g / (1 + I (2 pi / p)^2 / m).
TEST(Validation, Row17NutTurnsDownABolt) {
  Entry book("validation", "17", "a nut turns down a bolt by its weight, without friction",
             "closed form: a = g / (1 + I (2 pi / p)^2 / m), v = w p / (2 pi)");
  ScratchFolder folder("scree_row17");
  write_mesh(folder.path / "bolt.ply", bolt(-0.2, 0.06));
  write_mesh(folder.path / "nut.ply", nut());
  Normalisation const frame = normalisation_of(read_mesh(folder.path / "nut.ply"));  // of the rounded vertices
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.contact[0].kappa = 1e9;
  c.contact[0].damping_ratio = 0.5;
  GrainsCase g = grains_at("mesh:" + (folder.path / "nut.ply").string(), {frame.centroid}, 1 / frame.scale, 4000);
  g.insert.quaternion = {quat_of(transpose(frame.rotation))};
  g.evaluator = Evaluator::mesh;
  c.grains = {g};
  WallCase w;
  w.name = "bolt", w.material = "rock";
  w.kind = WallKind::mesh;
  w.inside = false;
  w.file = folder.path / "bolt.ply";
  c.wall = {w};
  c.time.end = 0.4;
  Simulation s(c, {});
  Vec3 const start = s.frame().position[0];
  // After the play is taken up: speed over a window.
  double const from = 0.15;
  double v0 = 0, t0 = 0, sideways = 0;
  while (s.step() == RunState::running) {
    Frame const f = s.frame();
    if (t0 == 0 && s.time() > from) t0 = s.time(), v0 = f.velocity[0].z;
    sideways = std::max(sideways, std::hypot(f.position[0].x - start.x, f.position[0].y - start.y));
    if (s.steps() % 50 == 0)
      book.point("height [m] against time [s]", s.time(), std::nan(""), f.position[0].z - start.z);
  }
  Frame const f = s.frame();
  double const mass = s.impl().scene.mass[0];
  Vec3 const axis = frame.rotation * Vec3{0, 0, 1};
  double const inertia = dot(axis, multiply(s.impl().scene.inertia[0], axis));
  double const a = gravity / (1 + inertia * std::pow(2 * M_PI / pitch, 2) / mass);
  // The facets of both threads make the nut chatter, which damping takes from it: up to a tenth.
  book.relative("acceleration", "m/s2", -a, (f.velocity[0].z - v0) / (s.time() - t0), 0.1);
  book.relative("speed over spin", "m/rad", pitch / (2 * M_PI), f.velocity[0].z / f.spin[0].z, 0.02);
  book.at_most("play sideways over the clearance", "", sideways / clearance, 2);
  book.at_most("ledger residual of the energy moved", "", std::abs(s.ledger().residual) / s.ledger().moved, 1e-3);
}

}  // namespace
}  // namespace scree::book
