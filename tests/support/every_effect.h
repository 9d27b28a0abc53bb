// every_effect.h: small scenes that use, between them, every effect, every law and every kind of shape and wall body.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "tests/support/cases.h"
#include "tests/support/pebble_decoder.h"
#include "tests/support/shape_kinds.h"

namespace scree::testing {

// A tetrahedron as a wall that lies in the way.
inline TriangleMesh wedge(double size) {
  TriangleMesh m;
  m.vertex = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  m.triangle = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return m;
}

// Pebbles that pass the gate: convex by construction, so in one piece, without holes, phi rising inwards.
inline Library certified_pebbles() {
  Library library = test::pebble_library();
  for (Shape& s : library.shape) {
    s.certificate.components = 1;
    s.certificate.euler = 2;
    s.certificate.falling = 0;
  }
  return library;
}

// One law with friction, damping, rolling resistance and cohesion.
inline Case sticky_case(ContactLaw law) {
  Case c = rock_case();
  c.contact[0].law = law;
  c.contact[0].youngs_modulus = 2e7;
  c.contact[0].poisson_ratio = 0.3;
  c.contact[0].stiffness = 2e5;
  c.contact[0].friction = 0.4;
  c.contact[0].damping_ratio = 0.3;
  c.contact[0].rolling = RollingCase{0.1, 2.25, 0.3};
  c.contact[0].cohesion = CohesionCase{500, 5e-4};
  c.gravity = Vec3{0, 0, -9.81};
  c.time.step = 1e-4;
  c.time.end = 0.15;
  return c;
}

inline GrainsCase poured(std::string const& name, std::vector<std::string> const& shapes, int count, double rate,
                         Box const& box, double diameter, int nodes) {
  GrainsCase g = grains_at("sphere", {}, diameter, nodes);
  g.name = name;
  g.shapes = shapes;
  g.count = count;
  g.insert.kind = InsertCase::Kind::rate;
  g.insert.orientation = Orientation::random;
  g.insert.box = box;
  g.insert.rate = rate;
  g.insert.velocity = {0, 0, -3};
  return g;
}

inline MeasureCase measured(std::string const& kind) {
  MeasureCase m;
  m.name = m.kind = kind;
  m.every = 0.0037;
  return m;
}

inline ForceCase pushed(std::string const& grains) {
  ForceCase f;
  f.name = "push";
  f.grains = grains;
  f.force = {0.5, 0, 0};
  f.torque = {0, 0.002, 0};
  f.start = 0.03;
  f.stop = 0.1;
  return f;
}

// Networks and ellipsoids that rain into a box with a wedge, under a force, damped by the settle schedule.
inline Case networks_on_a_wedge(std::filesystem::path const& folder) {
  Case c = sticky_case(ContactLaw::winkler);
  write_model(folder / "pebbles.h5", certified_pebbles(), true);
  write_mesh(folder / "wedge.stl", wedge(0.12));
  c.library = {{"pebbles", folder / "pebbles.h5"}};
  c.grains = {poured("nets", {"pebbles:*"}, 4, 100, {{0.04, 0.04, 0.08}, {0.16, 0.16, 0.2}}, 0.06, 120),
              poured("eggs", {"ellipsoid:1:0.8:0.6"}, 2, 80, {{0.04, 0.04, 0.08}, {0.16, 0.16, 0.2}}, 0.05, 120)};
  WallCase mesh;
  mesh.name = "wedge";
  mesh.material = "rock";
  mesh.kind = WallKind::mesh;
  mesh.inside = false;
  mesh.file = folder / "wedge.stl";
  c.wall = {open_box({0, 0, 0}, {0.2, 0.2, 0.2}), mesh};
  c.force = {pushed("nets")};
  c.measure = {measured("run_out"), measured("velocity")};
  c.measure[0].direction = Vec3{1, 0, 0};
  c.time.settle = SettleCase{5, 0.05, 1e-8, 0.2};
  return c;
}

// Spheres and boxes in a turning drum with a sliding floor below; what leaves through its side is deleted.
inline Case spheres_in_a_drum() {
  Case c = sticky_case(ContactLaw::hertz);
  c.contact[0].cohesion->range = 2e-4;
  c.grains = {poured("balls", {"sphere"}, 12, 100, {{-0.12, 0.02, -0.08}, {0.12, 0.28, 0.12}}, 0.04, 120),
              poured("bricks", {"box:1:1:2"}, 3, 30, {{-0.1, 0.05, -0.05}, {0.1, 0.25, 0.1}}, 0.05, 120)};
  for (GrainsCase& g : c.grains) g.evaluator = Evaluator::analytic;
  WallCase drum;
  drum.name = "drum";
  drum.material = "rock";
  drum.kind = WallKind::cylinder;
  drum.from = {0, 0, 0}, drum.to = {0, 0.3, 0};
  drum.radius = 0.2;
  drum.open = {"to"};
  drum.motion = MotionCase{};
  drum.motion->axis = {0, 1, 0};
  drum.motion->rate = -3;
  WallCase slide = open_box({-0.5, 0.25, -0.5}, {0.5, 0.8, -0.2});
  slide.name = "slide";
  slide.kind = WallKind::plane;
  slide.point = {0, 0, -0.5};
  slide.motion = MotionCase{};
  slide.motion->kind = MotionKind::translation;
  slide.motion->velocity = {0.3, 0, 0};
  slide.motion->start = 0.05;
  c.wall = {drum, slide};
  c.gravity = Vec3{0, 6, -8};
  c.drag = DragCase{1.2, 0.5, {0, 1, 0}};
  DeleteCase gone;
  gone.name = "out";
  gone.plane = true;
  gone.point = {0, 0.31, 0};
  gone.normal = {0, -1, 0};
  c.deletion = {gone};
  // With what they keep between samples.
  c.measure = {measured("wall_torque"), measured("discharge_rate"), measured("blockage")};
  c.measure[0].wall = "drum";
  for (int k : {1, 2}) c.measure[k].point = Vec3{0, 0.28, 0}, c.measure[k].normal = Vec3{0, 1, 0};
  c.measure[2].longer_than = 0.005;
  return c;
}

// Everything at once from the start: baked shapes and spheres, the linear law, damping by rate.
inline Case lattice_of_all_kinds(std::filesystem::path const& folder) {
  Case c = sticky_case(ContactLaw::linear);
  write_model(folder / "pebbles.h5", certified_pebbles(), true);
  c.library = {{"pebbles", folder / "pebbles.h5"}};
  auto const lattice = [&](std::string const& name, std::string const& shape, Evaluator evaluator, double z) {
    GrainsCase g = grains_at(shape, {}, 0.06, 120);
    g.name = name;
    g.evaluator = evaluator;
    g.count = 3;
    g.insert.kind = InsertCase::Kind::lattice;
    g.insert.orientation = Orientation::random;
    g.insert.box = {{0.02, 0.02, z}, {0.3, 0.12, z + 0.12}};
    g.insert.velocity = {0.3, 0.1, -1};
    g.insert.spin = {3, -2, 5};
    return g;
  };
  c.grains = {lattice("balls", "sphere", Evaluator::analytic, 0.02),
              lattice("grids", "ellipsoid:1:0.8:0.6", Evaluator::grid, 0.15),
              lattice("meshes", "box:1:1:1", Evaluator::mesh, 0.28),
              lattice("nets", "pebbles:*", Evaluator::net, 0.41)};
  c.wall = {open_box({0, 0, 0}, {0.32, 0.14, 0.4})};
  c.damping = DampingCase{0.5};
  c.force = {pushed("balls")};
  return c;
}

// Two replicas of spherical harmonics and of spheres that keep apart, poured into a box; some leave at its side.
inline Case replicas_of_harmonics(std::filesystem::path const& folder) {
  Case c = sticky_case(ContactLaw::winkler);
  write_model(folder / "lobes.h5", library_of_kind("harmonics"), true);
  c.library = {{"lobes", folder / "lobes.h5"}};
  Box const above{{0.02, 0.02, 0.01}, {0.18, 0.18, 0.12}};
  c.grains = {poured("lobes", {"lobes:*"}, 4, 200, above, 0.06, 120),
              poured("balls", {"sphere"}, 3, 200, above, 0.05, 120)};
  c.grains[1].apart = true;
  c.replicas = 2;
  WallCase box = open_box({0, 0, 0}, {0.2, 0.2, 0.2});
  box.open.push_back("+x");
  c.wall = {box};
  c.gravity = Vec3{8, 0, -9.81};
  DeleteCase gone;
  gone.name = "out";
  gone.plane = true;
  gone.point = {0.16, 0, 0};
  gone.normal = {-1, 0, 0};
  c.deletion = {gone};
  c.measure = {measured("run_out"), measured("discharge_rate")};
  c.measure[0].direction = Vec3{1, 0, 0};
  c.measure[1].deletion = "out";
  c.time.end = 0.05;
  return c;
}

// Spheres that a press squeezes far beyond any impact: the automatic step has to be halved on the way. Without gravity,
// whose fall would have been expected, and without nodes, whose entry would keep the step small.
inline Case grains_under_a_press() {
  Case c = sticky_case(ContactLaw::winkler);
  c.contact[0].cohesion.reset();
  c.gravity.reset();
  c.grains = {grains_at("sphere", {{0, 0, 0.03}, {0.058, 0, 0.03}, {0.03, 0.05, 0.03}}, 0.06, 120)};
  WallCase press = floor_at(0.0605);
  press.name = "press";
  press.normal = {0, 0, -1};
  press.motion = MotionCase{};
  press.motion->kind = MotionKind::translation;
  press.motion->velocity = {0.1, 0, -0.4};
  c.wall = {floor_at(0), press};
  c.time.step.reset();
  c.time.end = 0.03;
  return c;
}

}  // namespace scree::testing
