// seam_entries.cpp: resting on and sliding over seams of walls, edges between triangles, cells without data.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "shapes/mesh_files.h"
#include "tests/hard/course.h"
#include "tests/support/solids.h"

namespace scree::book {
namespace {

using namespace testing;
namespace fs = std::filesystem;

double constexpr d = 0.1, gravity = 9.81;

struct Floor {
  std::string name;
  std::vector<WallCase> wall;
};

WallCase block(std::string const& name, Vec3 low, Vec3 high) {
  WallCase w;
  w.name = name;
  w.material = "rock";
  w.kind = WallKind::box;
  w.inside = false;
  w.min = low, w.max = high;
  return w;
}

WallCase from_file(fs::path const& file, WallKind kind, double thickness) {
  WallCase w;
  w.name = "mesh";
  w.material = "rock";
  w.kind = kind;
  w.inside = false;
  w.thickness = thickness;
  w.file = file;
  return w;
}

// Level ground at z = 0 about the origin, with a seam through it each.
std::vector<Floor> floors(fs::path const& folder) {
  std::vector<Floor> out = {{"plane", {floor_at(0)}}};
  out.push_back({"two blocks side by side",
                 {block("left", {-0.5, -0.5, -0.2}, {0, 0.5, 0}), block("right", {0, -0.5, -0.2}, {0.5, 0.5, 0})}});
  write_mesh(folder / "coarse.stl", hexahedron(box_corners({-0.5, -0.5, -0.2}, {0.5, 0.5, 0})));
  out.push_back({"diagonal of two triangles", {from_file(folder / "coarse.stl", WallKind::mesh, 0)}});
  TriangleMesh sheet = sheet_mesh(0.5, 20);
  for (Vec3& v : sheet.vertex) v.z -= 1e-3;
  write_mesh(folder / "sheet.stl", sheet);
  out.push_back({"corner of six triangles of a sheet", {from_file(folder / "sheet.stl", WallKind::mesh, 2e-3)}});
  std::ofstream grid(folder / "level.asc");
  grid << "ncols 11\nnrows 11\nxllcorner 0\nyllcorner 0\ncellsize 0.1\nNODATA_value -9999\n";
  for (int i = 0; i < 121; ++i) grid << 0 << (i % 11 == 10 ? '\n' : ' ');
  grid.close();
  out.push_back({"terrain", {from_file(folder / "level.asc", WallKind::terrain, 0)}});
  out.back().wall[0].shift = {-0.55, -0.55, 0};
  return out;
}

class Folder {
 public:
  Folder() : at(fs::temp_directory_path() / ("scree_seams_" + std::to_string(::getpid()))) {
    fs::create_directories(at);
  }
  ~Folder() { fs::remove_all(at); }
  fs::path const at;
};

struct Ride {
  double height = 0;   // at the end [m]
  double highest = 0;  // largest speed upwards [m/s]
  double kinetic = 0;  // at the end [m g d]
  double along = 0;    // way [m]
};

Ride ride(Floor const& floor, char const* shape, double height, double speed, double friction, double seconds) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.contact[0].damping_ratio = 0.7;
  c.contact[0].friction = friction;
  c.grains = {grains_at(shape, {{-speed * seconds / 2, 0, height}}, d, 300)};
  c.grains[0].insert.velocity = {speed, 0, 0};
  c.wall = floor.wall;
  c.time.end = seconds;
  Simulation s(c, {});
  Ride out;
  Course const run = follow(s, [&] {
    if (s.time() > seconds / 4) out.highest = std::max(out.highest, s.frame().velocity[0].z);
  });
  EXPECT_EQ(run.stopped, "") << floor.name;
  out.height = s.frame().position[0].z, out.kinetic = run.kinetic;
  out.along = s.frame().position[0].x + speed * seconds / 2;
  return out;
}

TEST(Hard, SeamsAreNotFelt) {
  Entry book("hard", "seams", "a block rests on seams, and slides over them without friction",
             "the same as on a plane; popcorn is upward speed");
  Folder const folder;
  double const side = d * std::cbrt(M_PI / 6), kappa = 2e6 / (M_PI * 0.025 * 1e-3);
  double const sunk = 2650 * side * gravity / kappa, speed = 1, seconds = full() ? 0.5 : 0.04;
  Ride plane[2];
  for (Floor const& floor : floors(folder.at)) {
    for (bool slides : {false, true}) {
      Ride const r = ride(floor, "box:1:1:1", side / 2 - sunk, slides ? speed : 0, slides ? 0 : 0.5, seconds);
      std::string const name = floor.name + (slides ? ", sliding" : ", resting");
      if (floor.name == "plane") plane[slides] = r;
      // Seams of blocks carry edge nodes that make the ground stiffer where they are, by their share of the face.
      book.absolute(name + ": height against the plane", "overlaps", plane[slides].height / sunk, r.height / sunk, 0.5);
      book.at_most(name + ": popcorn, largest upward speed", "m/s", r.highest, 1e-3);
      if (slides)
        book.relative(name + ": way", "m", speed * seconds, r.along, 1e-4);
      else
        book.at_most(name + ": kinetic energy", "m g d", r.kinetic, 1e-7);
    }
  }
}

// A block larger than a hole of one cell lies on its rim; one that is smaller falls through.
TEST(Hard, NoDataCellsCarryNothing) {
  Entry book("hard", "nodata", "blocks over a cell without data",
             "a hole is open: what fits falls, what does not lies on its rim");
  Folder const folder;
  std::ofstream grid(folder.at / "hole.asc");
  grid << "ncols 9\nnrows 9\nxllcorner 0\nyllcorner 0\ncellsize 0.1\nNODATA_value -9999\n";
  for (int i = 0; i < 81; ++i) grid << (i == 40 ? -9999 : 0) << (i % 9 == 8 ? '\n' : ' ');
  grid.close();
  for (double size : {0.4, 0.05}) {
    Case c = rock_case();
    c.gravity = Vec3{0, 0, -gravity};
    c.contact[0].damping_ratio = 0.7;
    c.contact[0].friction = 0.5;
    c.contact[0].kappa = 2.5e10;
    c.grains = {grains_at("box:2:2:1", {{0, 0, size * std::cbrt(M_PI / 24) / 2}}, size, 500)};
    c.wall = {from_file(folder.at / "hole.asc", WallKind::terrain, 0)};
    c.wall[0].shift = {-0.45, -0.45, 0};
    c.time.end = 0.2;
    Simulation s(c, {});
    Course const run = follow(s);
    EXPECT_EQ(run.stopped, "");
    double const z = s.frame().position[0].z, drop = size * std::cbrt(M_PI / 24) / 2 - z;
    if (size > 0.2) {
      book.at_most("larger than the hole: sunk", "d", drop / size, 1e-3);
      book.at_most("larger than the hole: kinetic energy", "m g d", run.kinetic, 1e-6);
    } else {
      book.relative("smaller: fallen freely", "m", gravity * 0.2 * 0.2 / 2, drop, 1e-2);
    }
  }
}

}  // namespace
}  // namespace scree::book
