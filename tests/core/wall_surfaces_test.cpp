// wall_surfaces_test.cpp: walls as triangles: their volumes and places, through a results file, and in a picture.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/render.h"
#include "core/simulation.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
double constexpr pi = std::numbers::pi;
// A circle of 90 facets has this share of the disc's area.
double const facets = std::sin(2 * pi / 90) / (2 * pi / 90);

WallCase wall_of(WallKind kind) {
  WallCase w;
  w.name = "wall";
  w.material = "rock";
  w.kind = kind;
  w.from = {1, 2, 3}, w.to = {1, 4, 3};  // along y
  return w;
}

ResultsHeader header_of(WallCase const& wall, std::vector<Vec3> const& grains = {{}}) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", grains)};
  c.wall = {wall};
  return Simulation(c, {}).results_header();
}

TEST(WallSurfaces, EncloseTheirVolumes) {
  double const r = 0.3, length = 2;
  WallCase rod = wall_of(WallKind::cylinder), pill = wall_of(WallKind::capsule), cone = wall_of(WallKind::cone);
  rod.inside = false, rod.radius = pill.radius = r;
  cone.radius_from = 0.4, cone.radius_to = 0.8, cone.thickness = 0.02;
  WallCase block = wall_of(WallKind::box);
  block.inside = false, block.min = {0, 1, 2}, block.max = {2, 5, 4};
  double const slant = std::hypot(length, 0.4), middle = 0.6;
  // Pappus: the shell's cross-section, a strip with half discs at its ends, turned about the axis.
  double const shell = 2 * pi * (middle * slant * 0.02 + pi * 0.01 * 0.01 * middle);
  struct {
    char const* name;
    WallCase wall;
    double volume, tolerance;
  } const expected[] = {{"rod", rod, facets * pi * r * r * length, 1e-9},
                        {"block", block, 2 * 4 * 2, 1e-12},
                        {"pill", pill, facets * (pi * r * r * length + 4 * pi / 3 * r * r * r), 0.02},
                        {"cone", cone, facets * shell, 0.02}};  // rims and caps of 8 chords a quarter or half turn
  for (auto const& [name, wall, volume, tolerance] : expected) {
    ResultsHeader const h = header_of(wall);
    ASSERT_EQ(h.surface.size(), 1u) << name;
    MeshMass const m = mesh_mass(h.surface[0].mesh);
    EXPECT_NEAR(m.volume / volume, 1, tolerance) << name;
    if (wall.kind != WallKind::cone) EXPECT_NEAR(norm(m.centroid - Vec3{1, 3, 3}), 0, 1e-9) << name;
  }
}

TEST(WallSurfaces, ArriveThroughTheResultsFile) {
  WallCase drum = wall_of(WallKind::cylinder);
  drum.radius = 0.5;
  ResultsHeader const h = header_of(drum);
  auto const file = std::filesystem::temp_directory_path() / ("scree_surfaces_" + std::to_string(::getpid()) + ".h5");
  ResultsWriter(file, h).finish({});
  ResultsHeader const back = ResultsReader(file).header();
  std::filesystem::remove(file);
  ASSERT_EQ(back.surface.size(), h.surface.size());
  EXPECT_EQ(back.surface[0].name, "wall");
  EXPECT_TRUE(back.surface[0].glass);
  EXPECT_EQ(back.surface[0].mesh.vertex, h.surface[0].mesh.vertex);
  EXPECT_EQ(back.surface[0].mesh.triangle, h.surface[0].mesh.triangle);
  EXPECT_TRUE(header_of(floor_at(0)).surface.empty());  // planes at rest have their own record
}

// A sphere seen from +x through the middle of the picture; a wall between it and the eye.
int id_in_the_middle(WallCase const& wall) {
  Case c = rock_case();
  c.grains = {grains_at("sphere", {{}})};
  c.wall = {wall};
  Simulation s(c, {});
  RenderOptions o;
  o.width = o.height = 64;
  o.camera = Camera{};
  o.camera->eye = {2, 0, 0}, o.camera->target = {0, 0, 0};
  Rendering const r = render(s.results_header(), s.frame(), o);
  return r.id[32 * 64 + 32];
}

TEST(WallSurfaces, GlassShowsGrainsAndOpaqueWallsHideThem) {
  WallCase block = wall_of(WallKind::box), drum = wall_of(WallKind::cylinder), behind = block;
  block.inside = behind.inside = false;
  block.min = {0.5, -0.1, -0.1}, block.max = {0.7, 0.1, 0.1};
  behind.min = {-0.7, -0.1, -0.1}, behind.max = {-0.5, 0.1, 0.1};
  drum.from = {0, -1, 0}, drum.to = {0, 1, 0}, drum.radius = 0.6;
  EXPECT_EQ(id_in_the_middle(block), render_floor);
  EXPECT_EQ(id_in_the_middle(behind), 0);
  EXPECT_EQ(id_in_the_middle(drum), 0);
}

}  // namespace
}  // namespace scree
