// wall_entries.cpp: row 18 of the book: a wall from a formula and from any triangulation of it gives the same rebound.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/simulation.h"
#include "tests/support/box_surface.h"
#include "tests/support/cases.h"
#include "tests/support/scratch_folder.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

WallCase box_wall(bool inside, Vec3 low, Vec3 high) {
  WallCase w;
  w.name = "wall";
  w.material = "rock";
  w.kind = WallKind::box;
  w.inside = inside;
  w.min = low, w.max = high;
  return w;
}

// The same box as n x n squares a face in a file.
WallCase mesh_wall(ScratchFolder const& folder, WallCase const& box, int n) {
  WallCase w = box;
  w.kind = WallKind::mesh;
  w.file = folder.path / ("box" + std::to_string(n) + ".ply");
  write_mesh(w.file, box_surface(box.min, box.max, n));
  return w;
}

struct Rebound {
  Vec3 velocity, spin;
};

Rebound rebound(Case c, GrainsCase const& g, WallCase const& wall, double end) {
  c.grains = {g};
  c.wall = {wall};
  c.time.step = 1e-5;
  c.time.end = end;
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  return {s.frame().velocity[0], s.frame().spin[0]};
}

void compare(Entry& book, Rebound const& r, Rebound const& expected, int triangles) {
  std::string const what = ", " + std::to_string(triangles) + " triangles";
  double const v = norm(r.velocity - expected.velocity) / norm(expected.velocity);
  double const w = norm(r.spin - expected.spin) / norm(expected.spin);
  book.absolute("difference of the velocities" + what, "", 0, v, 1e-4);
  book.absolute("difference of the spins" + what, "", 0, w, 1e-4);
  book.point("difference of the velocities against triangles", triangles, 0, v);
}

// An ellipsoid thrown into a corner region of the container: it meets the floor and two sides, sliding. With Winkler's
// law even a corner agrees: where a node is behind two faces, the square of its distance to their edge is the sum of
// the squares of its depths.
TEST(Validation, Row18TriangulatedBoxReboundsAsTheAnalyticBox) {
  Entry book("validation", "18", "inside a box wall: formula and triangles", "the analytic wall");
  ScratchFolder folder("scree_row18");
  Case c = rock_case();
  c.contact[0].friction = 0.3;
  c.contact[0].damping_ratio = 0.1;
  GrainsCase g = grains_at("ellipsoid:1:0.8:0.6", {{0.42, 0.12, 0.1}});
  g.insert.quaternion = {normalized(Quat{0.9, 0.3, -0.2, 0.1})};
  g.insert.velocity = {2, 1, -1.5};
  g.insert.spin = {3, -5, 2};
  WallCase const box = box_wall(true, {0, 0, 0}, {0.6, 0.5, 0.4});
  Rebound const expected = rebound(c, g, box, 0.12);
  book.at_least("change of velocity: it did meet the walls", "m/s", norm(expected.velocity - g.insert.velocity), 1);
  for (int n : {1, 10, 100}) compare(book, rebound(c, g, mesh_wall(folder, box, n), 0.12), expected, 12 * n * n);
}

// From outside, onto a face: there the meshes carry the analytic box's edge nodes too.
TEST(Validation, Row18TriangulatedBlockReboundsAsTheAnalyticBlock) {
  Entry book("validation", "18b", "onto a block: formula and triangles", "the analytic wall");
  ScratchFolder folder("scree_row18b");
  Case c = rock_case();
  c.contact[0].friction = 0.3;
  GrainsCase g = grains_at("superellipsoid:1:0.8:0.7:0.6", {{0.03, 0.02, 0.26}});
  g.insert.quaternion = {normalized(Quat{0.8, 0.3, 0.4, 0.1})};
  g.insert.velocity = {0.5, 0, -2};
  WallCase const block = box_wall(false, {-0.3, -0.3, -0.2}, {0.3, 0.3, 0.2});
  Rebound const expected = rebound(c, g, block, 0.1);
  book.at_least("speed away from the block", "m/s", expected.velocity.z, 0.1);
  for (int n : {1, 10}) compare(book, rebound(c, g, mesh_wall(folder, block, n), 0.1), expected, 12 * n * n);
}

}  // namespace
}  // namespace scree::book
