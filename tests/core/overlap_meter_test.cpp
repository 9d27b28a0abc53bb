// overlap_meter_test.cpp: the overlap meter reads known overlaps: spheres, boxes, octahedra as networks, walls.
// SPDX-License-Identifier: Apache-2.0
#include "core/overlap_meter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "shapes/analytic_shapes.h"

namespace scree {
namespace {

double const pi = 3.141592653589793;
int constexpr points = 20000;
// Points of a surface of about pi d^2 are this far apart; half of it is a generous reach to the nearest one [d].
double const spacing = std::sqrt(pi / points);

struct Scenery {
  ResultsHeader header;
  Frame frame;

  void add(Shape const& shape, Vec3 position, Quat orientation = {}, double diameter = 0.1) {
    header.shape.push_back(static_cast<int>(header.library.shape.size()));
    header.library.shape.push_back(shape);
    header.diameter.push_back(diameter);
    frame.position.push_back(position);
    frame.orientation.push_back(normalized(orientation));
  }
  void add_wall(Vec3 point, Vec3 normal) { header.wall.push_back({"wall", point, normalized(normal)}); }
  OverlapReport measure(int threads = 2) const { return measure_overlap(header, frame, points, threads); }
};

Quat const tilted{0.8, 0.3, -0.4, 0.33};  // no axis along another

TEST(OverlapMeter, SpheresReadTheirOverlapAndTheirGap) {
  double const d = 0.1;
  Vec3 const along = normalized(Vec3{1, -0.7, 0.4});
  for (double overlap : {0.002, 0.01, 0.1}) {
    Scenery s;
    s.add(make_sphere(), {1, 2, 3}, {}, d);
    s.add(make_sphere(), Vec3{1, 2, 3} + along * (d * (1 - overlap)), tilted, d);
    OverlapReport const r = s.measure();
    // A point `e` off the axis reads e^2 / (2 R) less on either sphere, R = d / 2.
    EXPECT_LE(r.grain_grain.depth, overlap * (1 + 1e-9));
    EXPECT_GE(r.grain_grain.depth, overlap - 2 * spacing * spacing / 4);
    EXPECT_EQ(r.grain_grain.a, 0);
    EXPECT_EQ(r.grain_grain.b, 1);
    EXPECT_EQ(r.contacts, 1);
    EXPECT_EQ(r.coordination, 1);
    EXPECT_EQ(r.mean, r.grain_grain.depth);
    EXPECT_EQ(r.p99, r.grain_grain.depth);
  }
  Scenery apart;
  apart.add(make_sphere(), {1, 2, 3});
  apart.add(make_sphere(), Vec3{1, 2, 3} + along * (d * 1.0005), tilted);
  EXPECT_EQ(apart.measure().contacts, 0);
  EXPECT_EQ(apart.measure().grain_grain.depth, 0);
}

TEST(OverlapMeter, FarPairsAndWallsReadNothing) {
  Scenery s;
  s.add(make_sphere(), {0, 0, 1});
  s.add(make_box({1, 1, 1}), {7, 0, 1}, tilted);
  s.add(make_sphere(), {0, 3, 1});
  s.add_wall({0, 0, 0}, {0, 0, 1});
  OverlapReport const r = s.measure();
  EXPECT_EQ(r.contacts, 0);
  EXPECT_EQ(r.coordination, 0);
  EXPECT_EQ(r.grain_grain.a, -1);
  EXPECT_EQ(r.grain_wall.a, -1);
  EXPECT_EQ(r.grain_wall.depth + r.grain_grain.depth + r.mean + r.p99, 0);
}

TEST(OverlapMeter, UnequalSpheresCountInTheSmallerDiameter) {
  double const large = 0.3, small = 0.05, overlap = 0.02 * small;
  Scenery s;
  s.add(make_sphere(), {0, 0, 0}, {}, large);
  s.add(make_sphere(), {0, 0.5 * (large + small) - overlap, 0}, tilted, small);
  // Whichever carries the points: e^2 (1/R + 1/r) / 2 with e from the small sphere's set, e <= spacing small / 2.
  EXPECT_NEAR(s.measure().grain_grain.depth, overlap / small, 2 * spacing * spacing / 4);
}

TEST(OverlapMeter, BoxesFaceToFace) {
  double const d = 0.1, edge = d * std::cbrt(pi / 6), overlap = 0.015 * d;
  Scenery s;
  s.add(make_box({1, 1, 1}), {0, 0, 0}, {}, d);
  // Shifted along the face by a third: no corner meets a corner.
  s.add(make_box({1, 1, 1}), {edge - overlap, edge / 3, -edge / 3}, {}, d);
  EXPECT_NEAR(s.measure().grain_grain.depth, 0.015, 1e-5);  // points lie on their face to 1e-6 d
}

TEST(OverlapMeter, WallsReadTheSupportOfTheGrain) {
  double const d = 0.1, overlap = 0.01;
  Vec3 const normal = normalized(Vec3{0.2, -0.3, 1});
  Mat3 const r = to_matrix(normalized(tilted));
  for (Shape const& shape : {make_sphere(), make_ellipsoid({1, 0.8, 0.5}), make_superellipsoid({1, 0.8, 0.6}, 0.5, 0.5),
                             make_box({1, 0.8, 0.6})}) {
    double const height = support(shape.analytic, transposed_times(r, -normal), nullptr);  // [d]
    Scenery s;
    s.add(shape, normal * (d * (height - overlap)), tilted, d);
    s.add_wall({0, 0, 0}, normal);
    OverlapReport const report = s.measure();
    // Curvature radii here are above 0.15 d: e^2 / (2 R) lost at most. On corners the set has the corner itself.
    EXPECT_LE(report.grain_wall.depth, overlap + 1e-5);
    EXPECT_GE(report.grain_wall.depth, overlap - spacing * spacing / 4 / (2 * 0.15)) << to_string(shape.analytic.kind);
    EXPECT_EQ(report.grain_wall.b, -1);
    EXPECT_EQ(report.wall_contacts, 1);
    EXPECT_EQ(report.coordination, 1);
    s.frame.position[0] += normal * (d * 2 * overlap);  // lifted off by as much as it was in
    EXPECT_EQ(s.measure().contacts, 0);
  }
}

// |x| + |y| + |z| <= h, exactly, as a network: |x| = relu(x) + relu(-x).
Shape octahedron(Library& library, double h) {
  Mlp net;
  net.parameter = 0;
  net.width = {3, 6, 1};
  net.weight = {std::vector<float>(18, 0), std::vector<float>(6, static_cast<float>(-1 / std::sqrt(3.0)))};
  for (int k = 0; k < 3; ++k) net.weight[0][k * 6 + 2 * k] = 1, net.weight[0][k * 6 + 2 * k + 1] = -1;
  net.bias = {std::vector<float>(6, 0), {static_cast<float>(h / std::sqrt(3.0))}};
  library.net = {net};
  Shape s;
  s.name = "octahedron";
  s.kind = ShapeKind::net;
  s.net = 0;
  s.area = 4 * std::sqrt(3.0) * h * h;
  s.bounding_radius = h;
  s.box = {{-h, -h, -h}, {h, h, h}};
  return s;
}

TEST(OverlapMeter, NetworksFaceToFaceAndCornerInWall) {
  double const d = 0.1, h = std::cbrt(pi / 8), overlap = 0.01;  // volume 4/3 h^3 = pi/6
  Scenery s;
  Shape const shape = octahedron(s.header.library, h);
  Vec3 const face = normalized(Vec3{1, 1, 1});
  s.add(shape, {0, 0, 0}, {}, d);
  s.add(shape, face * (d * (2 * h / std::sqrt(3.0) - overlap)), {}, d);
  EXPECT_NEAR(s.measure().grain_grain.depth, overlap, 2e-5);  // the zero set is met to 1e-5 in float
  s.add_wall({0, 0, -d * (h - overlap)}, {0, 0, 1});
  OverlapReport const r = s.measure();
  // The lower corner of grain 0, to the accuracy at which the surface set stands on a corner.
  EXPECT_NEAR(r.grain_wall.depth, overlap, spacing / 8);
  EXPECT_EQ(r.grain_wall.a, 0);
  EXPECT_EQ(r.contacts, 2);
  EXPECT_EQ(r.coordination, 1.5);  // three ends of contacts on two grains
}

TEST(OverlapMeter, ManyContactsGiveMeanPercentileAndPair) {
  // A row of spheres, the k-th touching overlap k * 1e-3 d deeper than the one before; the set does not depend on
  // order.
  Scenery s;
  double x = 0, sum = 0;
  int const n = 11;
  for (int k = 0; k < n; ++k) {
    if (k > 0) x -= 0.1 * (1 - 1e-3 * k), sum += 1e-3 * k;
    s.add(make_sphere(), {x, 0, 0}, tilted);
  }
  OverlapReport const one = s.measure(1), two = s.measure(2);
  double const lost = 2 * spacing * spacing / 4;
  EXPECT_EQ(one.contacts, n - 1);
  EXPECT_NEAR(one.mean, sum / (n - 1), lost);
  EXPECT_EQ(one.grain_grain.a, n - 2);
  EXPECT_EQ(one.grain_grain.b, n - 1);
  EXPECT_EQ(one.p99, one.grain_grain.depth);
  EXPECT_EQ(one.coordination, 2.0 * (n - 1) / n);
  EXPECT_EQ(one.grain_grain.depth, two.grain_grain.depth);
  EXPECT_EQ(one.mean, two.mean);
}

TEST(OverlapMeter, RefusesAFrameOfAnotherRun) {
  Scenery s;
  s.add(make_sphere(), {0, 0, 0});
  s.frame.position.push_back({1, 1, 1});
  EXPECT_THROW(s.measure(), std::invalid_argument);
}

// A sphere of d = 0.1 whose centre is `depth` nearer to the wall's surface than its radius, at `centre` of the wall's
// frame; the wall stands in a pose of its own. A point e off the line of centres reads e^2 / 2 (1/r + 1/R) less.
void expect_depth(ResultsWallBody wall, Vec3 centre, double depth, double curvature) {
  double const d = 0.1, slack = spacing * spacing * d * d / 2 * (2 / d + curvature);
  wall.name = "wall";
  wall.position = {3, -2, 1};
  wall.orientation = normalized(tilted);
  Scenery s;
  Vec3 const at = wall.position + to_matrix(wall.orientation) * centre;
  s.add(make_sphere(), at, tilted, d);
  s.add_wall(at - Vec3{0, 0, 1}, {0, 0, 1});  // clear of it, so that the body is not the first wall
  s.header.wall_body = {wall};
  OverlapReport const r = s.measure();
  EXPECT_EQ(r.wall_contacts, depth > 0 ? 1 : 0);
  if (!(depth > 0)) return;
  EXPECT_EQ(r.grain_wall.b, -2);
  EXPECT_LE(r.grain_wall.depth * d, depth * (1 + 1e-9));
  EXPECT_GE(r.grain_wall.depth * d, depth - slack);
}

ResultsWallBody formula(WallSolidKind kind, AnalyticKind analytic, Vec3 half_size, double half_wall = 0) {
  ResultsWallBody w;
  w.kind = kind;
  w.formula.kind = analytic;
  w.formula.half_size = half_size;
  w.formula.half_wall = half_wall;
  return w;
}

TEST(OverlapMeter, WallBodiesReadTheirDepth) {
  double const r = 0.05;
  for (double depth : {0.002, 0.0005, -0.0005}) {
    // In a bore of R the surface is R from the axis; its curvature is away from the sphere.
    double const bore = 0.4;
    expect_depth(formula(WallSolidKind::bore, AnalyticKind::bore, {bore, bore, 1}), {0, bore - r + depth, 0.3}, depth,
                 -1 / bore);
    // On the side of a solid cylinder, and in the middle of its end.
    WallSolidKind const cylinder = WallSolidKind::cylinder;
    expect_depth(formula(cylinder, AnalyticKind::cylinder, {0.2, 0.2, 0.3}), {0, 0.2 + r - depth, 0.1}, depth, 1 / 0.2);
    expect_depth(formula(cylinder, AnalyticKind::cylinder, {0.2, 0.2, 0.3}), {0.01, 0, 0.3 + r - depth}, depth, 0);
    // Within a cone of 45 degrees: the middle of its wall is z + 0.3 from the axis, its inner face w further in.
    double const w = 0.01, inward = r + w - depth, z = 0.05;
    expect_depth(formula(WallSolidKind::funnel, AnalyticKind::funnel, {0.1, 0.5, 0.2}, w),
                 {z + 0.3 - inward / std::sqrt(2.0), 0, z + inward / std::sqrt(2.0)}, depth, 0);
    // Two triangles that rise 45 degrees along x: closest to the sphere at the origin.
    ResultsWallBody slope;
    slope.kind = WallSolidKind::terrain;
    slope.mesh = {{{-1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, -1}}, {{0, 1, 2}, {0, 2, 3}}};
    Vec3 const up = normalized(Vec3{-1, 0, 1});
    expect_depth(slope, up * (r - depth), depth, 0);
    // The same as a sheet, from below, and as the top of a closed wedge.
    slope.kind = WallSolidKind::sheet;
    slope.half_wall = 0.004;
    expect_depth(slope, up * -(r + 0.004 - depth), depth, 0);
    slope.kind = WallSolidKind::mesh;
    slope.half_wall = 0;
    slope.mesh = {{{-1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {1, 1, -1}},
                  {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {0, 3, 5}, {0, 5, 4}}};
    expect_depth(slope, up * (r - depth), depth, 0);
  }
}

TEST(OverlapMeter, WallsThatMoveAreWhereTheFrameHasThem) {
  Scenery s;
  s.add(make_sphere(), {0, 0, 0});
  ResultsWallBody plane = formula(WallSolidKind::plane, AnalyticKind::plane, {});
  plane.moving = true;
  plane.position = {0, 0, -0.049};  // at time 0 it would be in contact
  s.header.wall_body = {plane};
  EXPECT_THROW(s.measure(), std::invalid_argument);
  s.frame.wall_position = {{0, 0, -0.2}};
  s.frame.wall_orientation = {{}};
  EXPECT_EQ(s.measure().wall_contacts, 0);
  s.frame.wall_position = {{0, 0, 0.048}};
  s.frame.wall_orientation = {{0, 1, 0, 0}};  // upside down: solid above
  OverlapReport const r = s.measure();
  EXPECT_LE(r.grain_wall.depth, 0.02 * (1 + 1e-9));
  EXPECT_GE(r.grain_wall.depth, 0.02 - spacing * spacing);
}

// A body that has left takes no part, and every other keeps its own number.
TEST(OverlapMeter, BodiesThatLeftKeepTheirPlaces) {
  Scenery s;
  for (double x : {0.0, 0.2, 0.298}) s.add(make_sphere(), {x, 0, 0});
  s.header.activity = true;
  s.frame.activity = {Activity::deleted, Activity::active, Activity::active};
  OverlapReport const r = s.measure();
  ASSERT_EQ(r.of_body.size(), 3u);
  EXPECT_EQ(r.of_body[0], 0);
  EXPECT_EQ(r.of_body[1], r.grain_grain.depth);
  EXPECT_EQ(r.of_body[2], r.grain_grain.depth);
  EXPECT_NEAR(r.grain_grain.depth, 0.02, 2 * spacing * spacing / 4);  // as above
  EXPECT_EQ(r.coordination, 1);                                       // of those that are there
}

}  // namespace
}  // namespace scree
