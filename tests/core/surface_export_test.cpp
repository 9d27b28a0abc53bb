// surface_export_test.cpp: exported grains keep their volume, place, orientation and order.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/surface_export.h"
#include "shapes/analytic_shapes.h"

namespace scree {
namespace {

TEST(SurfaceExport, MeshesLieWhereTheGrainsAre) {
  ResultsHeader h;
  h.library.shape = {make_sphere(), make_ellipsoid({2, 1, 1})};
  h.shape_name = {"sphere", "ellipsoid:2:1:1"};
  h.shape = {1, 0, 1};
  h.diameter = {0.1, 0.2, 0.05};
  Frame frame;
  frame.position = {{1, 2, 3}, {-1, 0, 0.5}, {0, 0, 10}};
  frame.orientation = {quat_from_rotation_vector({0, 0, std::numbers::pi / 2}), {}, {}};  // x goes to y
  std::vector<TriangleMesh> const mesh = grain_meshes(h, frame, 1280);
  ASSERT_EQ(mesh.size(), 3u);
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    double const volume = std::numbers::pi / 6 * std::pow(h.diameter[i], 3);
    MeshMass const mass = mesh_mass(mesh[i]);
    EXPECT_NEAR(mass.volume / volume, 1, 0.02);  // chords of 1,280 triangles, stretched 2:1
    EXPECT_LT(mass.volume, volume);              // inscribed in a convex body
    EXPECT_NEAR(norm(mass.centroid - frame.position[i]), 0, 1e-4 * h.diameter[i]);
    sum += mass.volume;
  }
  // Ellipsoid 2:1:1 of unit equal-volume diameter: semi-axes 2, 1, 1 times (1 / 16)^(1/3).
  double const longest = 2 * std::cbrt(1.0 / 16) * 0.1;
  double reach_x = 0, reach_y = 0;
  for (Vec3 const& v : mesh[0].vertex) {
    reach_x = std::max(reach_x, std::abs(v.x - 1));
    reach_y = std::max(reach_y, std::abs(v.y - 2));
  }
  EXPECT_NEAR(reach_y, longest, 0.01 * longest);
  EXPECT_NEAR(reach_x, longest / 2, 0.01 * longest);
  TriangleMesh const all = joined(mesh);
  EXPECT_NEAR(mesh_mass(all).volume, sum, 1e-12);
  EXPECT_EQ(all.triangle.size(), 3 * mesh[0].triangle.size());
  EXPECT_TRUE(joined({}).triangle.empty());
}

}  // namespace
}  // namespace scree
