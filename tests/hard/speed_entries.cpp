// speed_entries.cpp: 100 m/s: impacts that the law carries rebound, others stop with a message; nothing tunnels.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "shapes/mesh_files.h"
#include "tests/hard/course.h"
#include "tests/support/solids.h"

namespace scree::book {
namespace {

using namespace testing;

// A smooth impact stores m v^2 / 2 = pi R kappa overlap^3 / 3.
double impact_overlap(double mass, double speed, double radius, double kappa) {
  return std::cbrt(1.5 * mass * speed * speed / (M_PI * radius * kappa));
}

TEST(Hard, ImpactAtAHundredMetresASecond) {
  Entry book("hard", "impact", "ellipsoid of revolution meets a wall at 100 m/s", "closed form of the smooth impact");
  double const d = 0.1, mass = 2650 * M_PI / 6 * d * d * d;
  for (double kappa : {2.5e10, 2.5e13}) {
    Case c = rock_case();
    c.contact[0].kappa = kappa;
    c.limits.overlap = 0.05;
    c.grains = {grains_at("ellipsoid:1:1:1", {{0, 0, 0.051}}, d, 2000)};
    c.grains[0].insert.velocity = {0, 0, -100};
    c.wall = {floor_at(0)};
    c.time.end = 2e-3;
    Simulation s(c, {});
    Course const run = follow(s);
    double const expected = impact_overlap(mass, 100, d / 2, kappa) / d;
    if (expected > c.limits.overlap) {
      EXPECT_TRUE(says(run.stopped, "overlap by") && says(run.stopped, "wall 'floor'")) << run.stopped;
      // The watch looks once a step.
      book.at_most("soft: overlap at which it was stopped", "d", run.overlap,
                   c.limits.overlap + 100 * s.time_step() / d);
    } else {
      add_sound_rows(book, "stiff", run, 1e-3, 1e-3);
      book.relative("stiff: overlap", "d", expected, run.overlap, 0.03);
      book.relative("stiff: rebound over impact speed, undamped", "", 1, s.frame().velocity[0].z / 100, 1e-3);
    }
  }
}

struct Plate {
  char const* name;
  WallKind kind;
  double thickness;  // of an open surface [m]; 0: closed
};

// Thrown at the middle of a plate 2 mm thick in the plane z = 0.
Case bullet(Plate const& plate, char const* shape, double speed, std::filesystem::path const& folder) {
  Case c = rock_case();
  double const d = 0.01;
  c.limits.overlap = 0.5;
  WallCase w;
  w.name = "plate";
  w.material = "rock";
  w.kind = plate.kind;
  w.inside = false;
  w.thickness = plate.thickness;
  w.min = {-0.05, -0.05, -1e-3}, w.max = {0.05, 0.05, 1e-3};
  if (plate.kind == WallKind::mesh) {
    w.file = folder / (std::string(plate.name) + ".stl");
    write_mesh(w.file, plate.thickness > 0 ? sheet_mesh(0.05, 4) : hexahedron(box_corners(w.min, w.max)));
  }
  c.wall = {w};
  c.grains = {grains_at(shape, {{0.003, -0.002, 0.03}}, d, 300)};
  c.grains[0].insert.velocity = {0, 0, -speed};
  c.time.end = 0.08 / speed;
  return c;
}

TEST(Hard, BulletsDoNotTunnel) {
  Entry book("hard", "bullet", "bullets through a 2 mm plate and an open triangle surface", "none arrives behind it");
  std::filesystem::path const folder =
      std::filesystem::temp_directory_path() / ("scree_bullet_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  Plate const plates[] = {
      {"box", WallKind::box, 0}, {"closed mesh", WallKind::mesh, 0}, {"open surface", WallKind::mesh, 2e-3}};
  for (Plate const& plate : plates) {
    int behind = 0, stopped = 0, silent = 0, runs = 0;
    for (char const* shape : {"sphere", "ellipsoid:1:0.8:0.6", "box:1:1:1"})
      for (double speed : {20.0, 100.0, 400.0})
        for (double step : {0.0, 2e-6, 1e-5, 1e-4, 3e-4}) {
          bool const few = step == 0 || step == 1e-4;  // automatic, and longer than the plate is thick
          if (!full() && !few) continue;
          Case c = bullet(plate, shape, speed, folder);
          if (step > 0) c.time.step = step;
          if (step > c.time.end) continue;
          Simulation s(c, {});
          Course const run = follow(s);
          ++runs;
          stopped += !run.stopped.empty();
          bool const through = s.frame().position[0].z < 0;
          behind += through && run.stopped.empty();
          bool const named = says(run.stopped, "wall 'plate'") || says(run.stopped, "critical step");
          silent += !run.stopped.empty() && !named;
          EXPECT_FALSE(through && run.stopped.empty())
              << plate.name << " " << shape << " " << speed << " m/s, step " << step;
          EXPECT_TRUE(run.stopped.empty() || named) << run.stopped;
          if (speed == 20 && step == 0) {
            EXPECT_EQ(run.stopped, "") << plate.name << " " << shape;
            EXPECT_GT(s.frame().velocity[0].z, 0) << plate.name << " " << shape;
          }
        }
    book.at_most(std::string(plate.name) + ": behind the plate without a word", "", behind, 0);
    book.at_most(std::string(plate.name) + ": stopped without its name", "", silent, 0);
    book.trend(std::string(plate.name) + ": share of runs that were stopped", "", static_cast<double>(stopped) / runs);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace scree::book
