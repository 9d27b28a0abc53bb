// wall_test.cpp: walls as bodies: prescribed motion and its work, closed forms of spheres against curved walls, sharp
// edges, and what is refused. Rebounds from formulas and triangulations are row 18 of the validation book.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/simulation_impl.h"
#include "core/wall_motion.h"
#include "shapes/mesh_files.h"
#include "tests/support/box_surface.h"
#include "tests/support/cases.h"
#include "tests/support/contact_sets.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

double const pi = 3.141592653589793;

class Walls : public ::testing::Test {
 protected:
  Walls() : folder(fs::temp_directory_path() / ("scree_walls_" + std::to_string(::getpid()))) {
    fs::create_directories(folder);
  }
  ~Walls() override { fs::remove_all(folder); }
  fs::path folder;
};

WallCase wall_of(WallKind kind, std::string const& name = "wall") {
  WallCase w;
  w.name = name;
  w.material = "rock";
  w.kind = kind;
  return w;
}

MotionCase turning(Vec3 axis, double rate, Vec3 through = {}) {
  MotionCase m;
  m.axis = axis, m.rate = rate, m.through = through;
  return m;
}
MotionCase moving(Vec3 velocity) {
  MotionCase m;
  m.kind = MotionKind::translation;
  m.velocity = velocity;
  return m;
}

// Force of the first step on a grain that overlaps a wall.
double first_force(Case c) {
  c.time.step = 1e-6;
  c.time.end = 1;
  Simulation s(c, {});
  return norm(s.impl().state.wrench.elastic[0].force);
}

// A sphere in closed form against the same sphere covered with nodes, on every smooth wall: F = pi R kappa delta^2 with
// the wall's curvature in R.
TEST(SphereOnWall, ClosedFormEqualsNodes) {
  struct {
    char const* name;
    WallCase wall;
    Vec3 at;
  } setup[3];
  double const delta = 0.004;  // deep enough for many nodes
  setup[0] = {"bore", wall_of(WallKind::cylinder), {0, 0, 0.2}};
  setup[0].wall.from = {0, 0, -1}, setup[0].wall.to = {0, 0, 1}, setup[0].wall.radius = 0.2;
  setup[0].at = {0.15 + delta, 0, 0.2};
  setup[1] = {"capsule", wall_of(WallKind::capsule), {0.1 + 0.05 - delta, 0, 0.1}};
  setup[1].wall.from = {0, 0, -1}, setup[1].wall.to = {0, 0, 1}, setup[1].wall.radius = 0.1;
  setup[2] = {"cone", wall_of(WallKind::cone), {}};
  setup[2].wall.from = {0, 0, 0}, setup[2].wall.to = {0, 0, 1};
  setup[2].wall.radius_from = 0.1, setup[2].wall.radius_to = 0.6, setup[2].wall.thickness = 0.02;
  Vec3 const slope = normalized(Vec3{-1, 0, 0.5});  // into the funnel, across the wall's middle line
  setup[2].at = Vec3{0.35, 0, 0.5} + slope * (0.01 + 0.05 - delta);
  for (auto const& [name, wall, at] : setup) {
    Case c = rock_case();
    c.wall = {wall};
    c.grains = {grains_at("sphere", {at})};
    double const closed = first_force(c);
    c.grains = {grains_at("ellipsoid:1:1:1", {at}, 0.1, 20000)};
    EXPECT_NEAR(first_force(c) / closed, 1, 0.03) << name;  // delta / R is 8 %; nodes are 1.3e-2 d apart
  }
}

TEST(SphereOnWall, IgnoresNodesWhereNoneAreNeeded) {
  Case c = rock_case();
  c.wall = {wall_of(WallKind::cylinder)};
  c.wall[0].radius = 0.5;
  c.grains = {grains_at("sphere", {{0, 0, 0.5}})};
  std::vector<std::string> const plain = {"bounds", "broad_phase", "sphere_contacts", "integrate", "watch"};
  EXPECT_EQ(Simulation(c, {}).plan().stages, plain);
  c.wall[0].motion = turning({0, 0, 1}, 1);
  EXPECT_EQ(Simulation(c, {}).plan().stages.front(), "wall_motion");
}

// A wall that is told to move and does not, since its time has not come, is the wall at rest to the bit, whatever stage
// would move it.
TEST(WallMotion, BeforeItsStartChangesNothing) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0.02, 0, 0.06}, {0, 0.03, 0.18}})};
  WallCase bore = wall_of(WallKind::cylinder);
  bore.from = {0, 0, 0}, bore.to = {0, 0, 1}, bore.radius = 0.15;
  c.time.end = 0.1;
  auto const last = [&](std::optional<MotionCase> motion) {
    c.wall = {bore, floor_at(0)};
    c.wall[0].open = {"from", "to"};
    c.wall[0].motion = motion;
    c.time.step = 5e-5;  // "auto" would get ready for the motion
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    return s.frame().position;
  };
  MotionCase later = turning({0, 0, 1}, 1);
  later.start = 1;
  EXPECT_EQ(last({}), last(later));
}

// A block on a belt that starts at speed V: it slides for V / (mu g); the belt does m V^2, half of it is lost.
TEST(WallMotion, BeltDoesTheWorkOfTheBookExample) {
  double const speed = 0.5, mu = 0.4, g = 9.81, d = 0.1;
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -g};
  c.contact[0].friction = mu;
  c.contact[0].damping_ratio = 0.7;
  double const half = 0.5 * d * std::cbrt(pi / 6 / 4);  // box 2:2:1 of volume pi/6 d^3
  c.grains = {grains_at("box:2:2:1", {{0, 0, half - 7e-6}}, d)};
  c.wall = {floor_at(0)};
  c.wall[0].motion = moving({speed, 0, 0});
  c.time.end = 0.2;
  c.time.safety = 0.2;
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  double const energy = s.impl().scene.mass[0] * speed * speed;
  EXPECT_NEAR(s.frame().velocity[0].x, speed, 2e-3 * speed);
  EXPECT_NEAR(s.ledger().wall_work / energy, 1, 0.01);  // the block also rocks a little when it starts
  EXPECT_NEAR(s.ledger().friction / (energy / 2), 1, 0.03);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved);
}

TEST(WallMotion, TablesAreIntegratedExactly) {
  MotionCase m = turning({0, 0, 2}, 0, {1, 0, 0});
  m.time = {1, 2, 4};
  m.rates = {0, 3, 1};
  // Trapezia: 0 before 1, 1.5 up to 2, 4 up to 4, then 1 a second.
  EXPECT_NEAR(shift_at(m, 0.5).angle, 0, 1e-15);
  EXPECT_NEAR(shift_at(m, 2).angle, 1.5, 1e-15);
  EXPECT_NEAR(shift_at(m, 3).angle, 1.5 + 2.5, 1e-15);
  EXPECT_NEAR(shift_at(m, 6).angle, 5.5 + 2, 1e-15);
  EXPECT_NEAR(rate_at(m, 3), 2, 1e-15);
  WallPose const pose = pose_at(m, {2, 0, 5}, {}, 6);  // radius 1 about (1, 0)
  EXPECT_NEAR(norm(pose.position - Vec3{1 + std::cos(7.5), std::sin(7.5), 5}), 0, 1e-14);
  MotionCase pulse = moving({2, 0, 0});
  pulse.start = 1, pulse.end = 3;
  EXPECT_NEAR(shift_at(pulse, 2).translation.x, 2, 1e-15);
  EXPECT_NEAR(shift_at(pulse, 9).translation.x, 4, 1e-15);
}

// A tumbling bed: ledger closes, node lists equal brute force, and torque times spin is the work of the wall.
TEST(WallMotion, DrumClosesItsLedgerAndItsPower) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.5;
  c.grains = {
      grains_at("ellipsoid:1:0.8:0.6", {{0.0, 0, -0.1}, {0.1, 0, -0.05}, {-0.1, 0, -0.05}, {0, 0, 0.02}}, 0.1, 500)};
  WallCase drum = wall_of(WallKind::cylinder);
  drum.from = {0, -0.07, 0}, drum.to = {0, 0.07, 0}, drum.radius = 0.2;
  drum.motion = turning({0, 1, 0}, -4);
  c.wall = {drum};
  c.time.end = 0.3;
  Simulation s(c, {});
  double work = 0;
  auto const power = [&] {
    Simulation::Impl const& i = s.impl();
    double torque = 0;
    for (std::size_t w = 0; w < i.scene.wall.size(); ++w) {
      std::size_t const b = i.scene.bodies() + w;
      for (Wrench const& f : {i.state.wrench.elastic[b], i.state.wrench.damping[b], i.state.wrench.friction[b]})
        torque += f.torque.y + cross(i.state.position[b], f.force).y;
    }
    return -torque * -4;
  };
  double before = power();
  while (s.step() == RunState::running) {
    double const now = power();
    work += 0.5 * (before + now) * s.time_step();
    before = now;
  }
  EXPECT_GT(s.ledger().wall_work, 0.1);
  EXPECT_NEAR(work / s.ledger().wall_work, 1, 1e-3);
  EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved);
}

// A box grain laid with a face over the edge of a block, between its own nodes: without the wall's nodes nothing would
// hold it before its own came in.
TEST(SharpEdge, HoldsAFlatFace) {
  Case c = rock_case();
  c.contact[0].damping_ratio = 0.5;
  WallCase block = wall_of(WallKind::box);
  block.inside = false;
  block.min = {-0.2, -0.2, -0.2}, block.max = {0, 0.2, 0};
  double const half = 0.5 * 0.1 * std::cbrt(pi / 6);
  GrainsCase g = grains_at("box:1:1:1", {{}});
  Quat const tilt = quat_from_rotation_vector({0, pi / 4, 0});  // the face looks down the edge's bisector
  g.insert.quaternion = {tilt};
  g.insert.position = {to_matrix(tilt) * Vec3{0, 0, half + 2e-4}};
  g.insert.velocity = to_matrix(tilt) * Vec3{0, 0, -0.3};
  c.grains = {g};
  c.wall = {block};
  c.time.end = 0.02;
  Simulation s(c, {});
  double deepest = 0;
  while (s.step() == RunState::running) deepest = std::max(deepest, s.largest_overlap());
  EXPECT_GT(s.frame().velocity[0].z, 0);  // thrown back
  EXPECT_LT(deepest, 0.02);
  EXPECT_LT(std::abs(s.ledger().residual), 2e-3 * s.ledger().moved);
}

TEST_F(Walls, NodeListsEqualBruteForce) {
  WallCase mesh = wall_of(WallKind::mesh);
  mesh.inside = false;
  mesh.file = folder / "block.stl";
  write_mesh(mesh.file, box_surface({-0.2, -0.2, -0.2}, {0.05, 0.2, 0}, 3));
  mesh.motion = turning({0, 1, 0}, 2, {0.05, 0, 0});
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].friction = 0.5;
  c.contact[0].damping_ratio = 0.3;
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0.04, 0, 0.06}, {-0.05, 0.01, 0.06}}, 0.1, 500)};
  c.wall = {mesh};
  c.time.end = 0.05;
  c.time.step = 2e-5;
  Simulation fast(c, {}), slow(c, {.brute_force = true});
  bool touched = false;
  for (RunState now = RunState::running; now == RunState::running;) {
    now = fast.step();
    slow.step();
    auto const a = active_nodes(fast), b = active_nodes(slow);
    ASSERT_EQ(a, b) << "step " << fast.steps();
    touched = touched || !a.empty();
  }
  EXPECT_TRUE(touched);
  EXPECT_EQ(fast.frame().position, slow.frame().position);
}

TEST_F(Walls, TerrainCarriesAndEndsAtItsBorder) {
  fs::path const file = folder / "slope.asc";
  std::ofstream(file) << "ncols 6\nnrows 5\nxllcorner 3400000\nyllcorner 5600000\ncellsize 0.2\nNODATA_value -9999\n"
                         "0.5 0.5 0.5 0.5 0.5 0.5\n0.5 0.5 0.5 0.5 0.5 0.5\n0.5 0.5 0.5 0.5 0.5 -9999\n"
                         "0.5 0.5 0.5 0.5 0.5 0.5\n0.5 0.5 0.5 0.5 0.5 0.5\n";
  WallCase terrain = wall_of(WallKind::terrain);
  terrain.file = file;
  terrain.shift = {0, 0, -0.5};
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].damping_ratio = 0.7;
  // One on the level ground, one over the hole, one beside the grid.
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0.5, 0.5, 0.0384}, {1.05, 0.5, 0.0384}, {-0.2, 0.5, 0.0384}})};
  c.wall = {terrain};
  c.time.end = 0.3;
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  EXPECT_NEAR(s.frame().position[0].z, 0.03 / std::cbrt(0.48), 1e-3);
  EXPECT_LT(s.frame().position[1].z, -0.3);
  EXPECT_LT(s.frame().position[2].z, -0.3);
}

TEST_F(Walls, OpenSurfaceNeedsItsThickness) {
  TriangleMesh open = box_surface({0, 0, 0}, {1, 1, 1}, 1);
  open.triangle.resize(10);
  WallCase w = wall_of(WallKind::mesh, "hopper");
  w.file = folder / "open.stl";
  write_mesh(w.file, open);
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{0.5, 0.5, 0.5}})};
  c.wall = {w};
  try {
    Simulation(c, {});
    FAIL() << "an open container was taken";
  } catch (InputError const& e) {
    EXPECT_NE(std::string(e.what()).find("wall 'hopper'"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("open along"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("thickness"), std::string::npos) << e.what();
  }
  c.wall[0].thickness = 0.02;
  Simulation s(c, {});
  // Nodes along its folds and borders, on both sides of each fold's skin.
  EXPECT_GT(s.impl().scene.shape.back().nodes, 100);
}

// A lid that tips under a sphere lifts it: the normal force has a lever arm about the hinge, not about the sphere.
TEST(WallMotion, ATippingPlanesWorkOnASphereIsInTheLedger) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].damping_ratio = 0.5;
  c.grains = {grains_at("sphere", {{0.5, 0, 0.0495}})};
  c.wall = {floor_at(0)};
  MotionCase& tip = c.wall[0].motion.emplace();
  tip.axis = {0, -1, 0};  // lifts +x
  tip.rate = 0.5;
  c.time.end = 0.2;
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  LedgerRow const row = s.ledger();
  EXPECT_GT(row.wall_work, 2650 * 3.14159 / 6 * 1e-3 * 9.81 * 0.5 * std::sin(0.5 * 0.19));  // lifted by that much
  EXPECT_LT(std::abs(row.residual), 1e-3 * row.moved);
}

}  // namespace
}  // namespace scree
