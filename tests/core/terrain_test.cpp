// terrain_test.cpp: where a terrain ends: its solid seen from the side, and the energy of grains that cross its border.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "core/simulation_impl.h"
#include "core/wall_record.h"
#include "core/wall_surface.h"
#include "shapes/terrain_file.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;
namespace fs = std::filesystem;

// A grid of cells of 0.2 m whose surface is z = slope x over 0.1 <= x <= 1.1, 0.1 <= y <= 1.1.
std::string tilted_grid(double slope) {
  std::string text = "ncols 6\nnrows 6\nxllcorner 0\nyllcorner 0\ncellsize 0.2\nNODATA_value -9999\n";
  for (int i = 0; i < 36; ++i) text += std::to_string(slope * (0.2 * (i % 6) + 0.1)) + (i % 6 == 5 ? "\n" : " ");
  return text;
}

// The ground is what lies below the surface within its footprint: of a level grid it is a tall box.
TEST(Terrain, IsASolidThatEndsWithItsFootprint) {
  ResultsWallBody wall;
  wall.kind = WallSolidKind::terrain;
  wall.mesh = parse_terrain("level.asc", tilted_grid(0));
  WallPhi const phi(wall);
  AnalyticSdf box;
  box.kind = AnalyticKind::box;
  box.half_size = {0.5, 0.5, 10};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> side(-0.3, 1.5), height(-0.5, 0.3);
  for (int i = 0; i < 2000; ++i) {
    Vec3 const x{side(random), side(random), height(random)};
    Vec3 gradient, expected;
    double const there = signed_distance(box, x - Vec3{0.6, 0.6, -10}, &expected);
    EXPECT_NEAR(phi(x, &gradient), there, 1e-12);
    if (std::fabs(there) > 1e-6) {
      EXPECT_LT(norm(gradient - expected), 1e-6);
    }
  }
}

// phi never jumps, whatever the slope does at the border, and never changes faster than the way taken.
TEST(Terrain, PhiIsContinuousAcrossTheBorder) {
  for (double slope : {-0.7, 0.7}) {
    ResultsWallBody wall;
    wall.kind = WallSolidKind::terrain;
    wall.mesh = parse_terrain("tilted.asc", tilted_grid(slope));
    WallPhi const phi(wall);
    double constexpr step = 5e-4;
    for (double depth : {0.3, 0.05, 1e-3, -0.05})
      for (double x = -0.3; x < 1.5; x += step) {
        Vec3 const a{x, 0.47, slope * x - depth}, b{x + step, 0.47, slope * (x + step) - depth};
        ASSERT_LE(std::fabs(phi(b) - phi(a)), norm(b - a) * (1 + 1e-9)) << "x = " << x << ", depth " << depth;
      }
  }
}

class TerrainBorder : public ::testing::Test {
 protected:
  TerrainBorder() : folder_(fs::temp_directory_path() / ("scree_terrain_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~TerrainBorder() override { fs::remove_all(folder_); }

  // One grain on ground that falls by `slope` along x and ends at x = 1.1 m; lossless, with friction when asked.
  Case over_the_border(double slope, Vec3 position, Vec3 velocity, double friction) {
    fs::path const file = folder_ / "ground.asc";
    std::ofstream(file) << tilted_grid(-slope);
    Case c = rock_case();
    c.gravity = Vec3{0, 0, -9.81};
    if (friction > 0) c.contact[0].friction = friction;
    c.grains = {grains_at("ellipsoid:1:0.8:0.6", {position})};
    c.grains[0].insert.velocity = velocity;
    c.wall = {floor_at(0)};
    c.wall[0].kind = WallKind::terrain;
    c.wall[0].file = file;
    return c;
  }
  fs::path folder_;
};

TEST_F(TerrainBorder, AGrainThatRollsOverItKeepsItsEnergy) {
  for (double slope : {0.0, 0.3}) {
    Case c = over_the_border(slope, {1.08, 0.6, -1.08 * slope + 0.045}, {0.3, 0, 0}, 0.5);
    c.contact[0].damping_ratio = 0.3;
    c.time.end = 0.4;
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    EXPECT_LT(s.frame().position[0].z, -0.1 - 1.1 * slope) << "it fell beside the ground";
    EXPECT_LT(std::abs(s.ledger().residual), 1e-3 * s.ledger().moved) << "slope " << slope;
  }
}

// Dropped with its centre beyond the border: what of it is over the ground is thrown back, and nothing is lost or made.
TEST_F(TerrainBorder, AGrainThatStrikesItFromBeyondKeepsItsEnergy) {
  for (double beyond : {0.02, 0.035}) {
    Case c = over_the_border(0, {1.1 + beyond, 0.6, 0.06}, {-0.3, 0, -1}, 0);
    c.time.end = 0.08;
    Simulation s(c, {});
    double deepest = 0;
    while (s.step() == RunState::running) deepest = std::max(deepest, s.largest_overlap());
    EXPECT_GT(deepest, 1e-3) << "it did strike";
    // Undamped, so that all of the residual is the field's. On a sharp edge forces turn by 90 degrees from one node to
    // the next: the edge of a box wall leaves 1e-3 to 3e-3 of the energy moved, too.
    EXPECT_LT(std::abs(s.ledger().residual), 5e-3 * s.ledger().moved) << "centre beyond by " << beyond;
  }
}

// Beyond the border and clear of it there is nothing: a free fall to the last digit.
TEST_F(TerrainBorder, NothingActsBeyondIt) {
  Case c = over_the_border(0, {1.1 + 0.07, 0.6, 0.02}, {0.1, 0, 0}, 0.5);
  c.time.end = 0.1;
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  EXPECT_EQ(s.frame().velocity[0].x, 0.1);
  EXPECT_NEAR(s.frame().position[0].z, 0.02 - 9.81 * s.time() * s.time() / 2, 1e-12);
}

TEST_F(TerrainBorder, ResultsKeepTheSurfaceWithoutItsSides) {
  Case const c = over_the_border(0.2, {0.6, 0.6, 0.5}, {}, 0);
  Simulation s(c, {});
  std::vector<ResultsWallBody> const wall = recorded_wall_bodies(c, s.impl().scene);
  ASSERT_EQ(wall.size(), 1u);
  EXPECT_EQ(wall[0].mesh.vertex.size(), 36u);
  EXPECT_EQ(wall[0].mesh.triangle.size(), 2u * 25);
  EXPECT_EQ(s.impl().scene.mesh_corner.size(), 3u * (2 * 25 + 2 * 20));
}

}  // namespace
}  // namespace scree
