// wall_surface_test.cpp: triangles of walls lie on the solids they stand for, face the free space and move with them.
// SPDX-License-Identifier: Apache-2.0
#include "core/wall_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/render.h"
#include "core/simulation.h"
#include "core/surface_export.h"
#include "shapes/mesh_report.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

double constexpr pi = std::numbers::pi;

ResultsWallBody body_of(WallSolidKind kind, AnalyticKind formula, Vec3 half_size, double half_wall = 0) {
  ResultsWallBody w;
  w.name = "w";
  w.kind = kind;
  w.formula.kind = formula;
  w.formula.half_size = half_size;
  w.formula.half_wall = half_wall;
  return w;
}

// Twice the area vector of a triangle.
Vec3 area_vector(TriangleMesh const& m, std::array<int, 3> const& t) {
  return cross(m.vertex[t[1]] - m.vertex[t[0]], m.vertex[t[2]] - m.vertex[t[0]]);
}

// Vertices lie on phi = 0 and triangles face down phi, i.e. into the free space. Directions differ from the middle of
// the triangle's surface by half a segment of the circle or of a rim.
void expect_on_surface(ResultsWallBody const& wall) {
  TriangleMesh const m = wall_surface(wall);
  WallPhi const phi(wall);
  for (Vec3 const& v : m.vertex) EXPECT_NEAR(phi(v), 0, 1e-12);
  for (auto const& t : m.triangle) {
    Vec3 const middle = (m.vertex[t[0]] + m.vertex[t[1]] + m.vertex[t[2]]) * (1.0 / 3);
    Vec3 gradient;
    phi(middle, &gradient);
    EXPECT_GT(dot(normalized(area_vector(m, t)), -gradient), std::cos(pi / 16));
  }
}

// Area of the regular polygon of a circle over the circle's.
double const polygon = std::sin(2 * pi / circle_segments) / (2 * pi / circle_segments);

TEST(WallSurface, ClosedSolidsKeepTheirVolume) {
  double const r = 0.4, h = 0.7;
  ResultsWallBody const cylinder = body_of(WallSolidKind::cylinder, AnalyticKind::cylinder, {r, r, h});
  EXPECT_NEAR(mesh_mass(wall_surface(cylinder)).volume, polygon * pi * r * r * 2 * h, 1e-12);
  ResultsWallBody const box = body_of(WallSolidKind::box, AnalyticKind::box, {0.1, 0.2, 0.3});
  EXPECT_NEAR(mesh_mass(wall_surface(box)).volume, 0.2 * 0.4 * 0.6, 1e-12);
  // Arcs in steps of pi / 16 lack (pi / 16)^2 / 4 = 1 % of a ball, circles of 128 segments 0.04 % of all; a funnel's
  // rims, which the arcs cut, are 3 % of its volume.
  ResultsWallBody const capsule = body_of(WallSolidKind::capsule, AnalyticKind::capsule, {r, r, h});
  double const ball = 4 * pi / 3 * r * r * r;
  EXPECT_NEAR(mesh_mass(wall_surface(capsule)).volume, pi * r * r * 2 * h + ball, 0.012 * ball);
  double const low = 0.1, high = 0.5, w = 0.02, length = std::hypot(high - low, 2 * h);
  ResultsWallBody const funnel = body_of(WallSolidKind::funnel, AnalyticKind::funnel, {low, high, h}, w);
  double const pappus = (2 * w * length + pi * w * w) * pi * (low + high);
  EXPECT_NEAR(mesh_mass(wall_surface(funnel)).volume, pappus, 0.002 * pappus);
  for (ResultsWallBody const& wall : {cylinder, box, capsule, funnel}) {
    EXPECT_TRUE(report_mesh(wall_surface(wall)).defects.empty()) << static_cast<int>(wall.kind);
    expect_on_surface(wall);
  }
}

TEST(WallSurface, BoreFacesItsAxisAndHasTheLengthOfItsWall) {
  ResultsWallBody const bore = body_of(WallSolidKind::bore, AnalyticKind::bore, {0.5, 0.5, 0.15});
  expect_on_surface(bore);
  TriangleMesh const m = wall_surface(bore);
  double area = 0;
  for (auto const& t : m.triangle) area += norm(area_vector(m, t)) / 2;
  EXPECT_NEAR(area, 0.3 * 2 * 0.5 * circle_segments * std::sin(pi / circle_segments), 1e-12);
}

TEST(WallSurface, FunnelThatEndsInAPointStaysOnItsSideOfTheAxis) {
  TriangleMesh const m = wall_surface(body_of(WallSolidKind::funnel, AnalyticKind::funnel, {0, 0.5, 0.5}, 0.01));
  for (Vec3 const& v : m.vertex) EXPECT_TRUE(is_finite(v));
  EXPECT_GT(mesh_mass(m).volume, 0);
}

// A drum D 1 m, L 0.3 m that turns about y, and a block that does not.
Case drum_case() {
  Case c;
  c.time.end = 0.01;
  c.time.step = 1e-3;
  c.material.push_back({});
  c.material.back().name = "m";
  WallCase drum;
  drum.name = "drum";
  drum.material = "m";
  drum.kind = WallKind::cylinder;
  drum.from = {0, -0.15, 0};
  drum.to = {0, 0.15, 0};
  drum.radius = 0.5;
  drum.motion = MotionCase{};
  drum.motion->axis = {0, 1, 0};
  drum.motion->rate = -0.2 * pi;
  WallCase block;
  block.name = "block";
  block.material = "m";
  block.kind = WallKind::box;
  block.inside = false;
  block.min = {1, 1, 1};
  block.max = {1.2, 1.4, 1.6};
  c.wall = {drum, block};
  return c;
}

TEST(WallSurface, RunRecordsItsWallsAndWhereTheyAre) {
  Case const c = drum_case();
  Simulation simulation(c, {});
  ResultsHeader const h = simulation.results_header();
  ASSERT_EQ(h.wall_body.size(), 4u);  // bore, two ends, block
  EXPECT_EQ(h.wall_body[0].kind, WallSolidKind::bore);
  EXPECT_EQ(h.wall_body[1].kind, WallSolidKind::plane);
  EXPECT_EQ(h.wall_body[3].kind, WallSolidKind::box);
  EXPECT_TRUE(h.wall_body[0].inside && h.wall_body[0].moving);
  EXPECT_FALSE(h.wall_body[3].inside || h.wall_body[3].moving);
  // The domain is the walls' boxes: vertices of the circle are 0.5 cos(pi / 128) or more from the axis.
  EXPECT_NEAR(h.domain.min.x, -0.5, 0.5 * (1 - std::cos(pi / circle_segments)));
  EXPECT_NEAR(h.domain.min.y, -0.15, 1e-12);
  EXPECT_NEAR(norm(h.domain.max - Vec3{1.2, 1.4, 1.6}), 0, 1e-12);
  while (simulation.step() == RunState::running) {
  }
  Frame const frame = simulation.frame();
  ASSERT_EQ(frame.wall_position.size(), 3u);
  for (int w = 0; w < 3; ++w) {
    ResultsWallBody const& wall = h.wall_body[w];
    WallPose const expected = pose_at(*c.wall[0].motion, wall.position, wall.orientation, frame.time);
    WallPose const pose = wall_pose(h, frame, w);
    EXPECT_LT(norm(pose.position - expected.position), 1e-12);
    EXPECT_LT(norm(to_matrix(pose.orientation) * Vec3{1, 2, 3} - to_matrix(expected.orientation) * Vec3{1, 2, 3}),
              1e-12);
  }
  EXPECT_THROW(wall_pose(h, Frame{}, 0), std::invalid_argument);
  EXPECT_EQ(wall_pose(h, Frame{}, 3).position, (Vec3{1.1, 1.2, 1.3}));

  std::vector<TriangleMesh> const world = wall_meshes(h, frame);
  ASSERT_EQ(world.size(), 4u);
  for (int end : {1, 2}) {  // discs across y that face each other
    Vec3 sum;
    for (Vec3 const& v : world[end].vertex) EXPECT_NEAR(v.y, end == 1 ? -0.15 : 0.15, 1e-12);
    for (auto const& t : world[end].triangle) sum += area_vector(world[end], t) * 0.5;
    EXPECT_NEAR(sum.y, (end == 1 ? 1 : -1) * polygon * pi * 0.25, 1e-12);
  }
  EXPECT_NEAR(mesh_mass(world[3]).volume, 0.2 * 0.4 * 0.6, 1e-12);
}

TEST(WallSurface, FacesOfAMovingBoxAreItsRectangles) {
  Case c = drum_case();
  WallCase box = c.wall[1];
  box.inside = true;
  box.open = {"+z"};
  box.motion = MotionCase{};
  box.motion->kind = MotionKind::translation;
  box.motion->velocity = {3, 0, 0};
  c.wall = {box};
  Simulation simulation(c, {});
  ResultsHeader const h = simulation.results_header();
  ASSERT_EQ(h.wall_body.size(), 5u);
  while (simulation.step() == RunState::running) {
  }
  Frame const frame = simulation.frame();
  TriangleMesh const all = joined(wall_meshes(h, frame));
  // Closed with the lid, whose normal is -z: the divergence theorem about the lid gives minus the volume.
  double volume = 0;
  Vec3 const lid{0, 0, 1.6};
  for (auto const& t : all.triangle) volume += dot(all.vertex[t[0]] - lid, area_vector(all, t)) / 6;
  EXPECT_NEAR(volume, -0.2 * 0.4 * 0.6, 1e-12);
  double low = 1e300;
  for (Vec3 const& v : all.vertex) low = std::min(low, v.x);
  EXPECT_NEAR(low, 1 + 3 * frame.time, 1e-12);
}

// A sphere seen from +x through the middle of the picture; a wall between it and the eye.
int id_in_the_middle(WallCase wall) {
  Case c = testing::rock_case();
  c.grains = {testing::grains_at("sphere", {{}})};
  wall.material = "rock";
  c.wall = {wall};
  Simulation s(c, {});
  RenderOptions o;
  o.width = o.height = 64;
  o.camera = Camera{};
  o.camera->eye = {2, 0, 0}, o.camera->target = {0, 0, 0};
  Rendering const r = render(s.results_header(), s.frame(), o);
  return r.id[32 * 64 + 32];
}

TEST(WallSurface, GlassShowsGrainsAndOpaqueWallsHideThem) {
  Case const c = drum_case();
  WallCase drum = c.wall[0], block = c.wall[1], behind = block;
  block.min = {0.5, -0.1, -0.1}, block.max = {0.7, 0.1, 0.1};
  behind.min = {-0.7, -0.1, -0.1}, behind.max = {-0.5, 0.1, 0.1};
  EXPECT_EQ(id_in_the_middle(block), render_floor);
  EXPECT_EQ(id_in_the_middle(behind), 0);
  EXPECT_EQ(id_in_the_middle(drum), 0);
}

}  // namespace
}  // namespace scree
