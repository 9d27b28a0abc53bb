// test_shape_kinds.cpp: what every kind of shape must offer, by one body of test code.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>

#include "shapes/bake.h"
#include "shapes/model_file.h"
#include "shapes/phi_batch.h"
#include "shapes/surface_nodes.h"
#include "shapes/zero_set.h"
#include "tests/support/shape_kinds.h"

namespace scree {
namespace {

using namespace testing;

class ShapeKinds : public ::testing::TestWithParam<char const*> {
 protected:
  // Made once: normalising takes longer than most tests.
  static Library const& kept(std::string const& kind) {
    static std::map<std::string, Library> made;
    auto const at = made.find(kind);
    return at != made.end() ? at->second : made.emplace(kind, library_of_kind(kind)).first->second;
  }
  Library const& library = kept(GetParam());
  Shape const& shape = library.shape.at(0);
  std::string const kind = GetParam();
  std::mt19937 random{7};

  // A random point of the cube around the bounding ball, at most `reach` bounding radii from the centre.
  Vec3 draw(double reach) {
    std::uniform_real_distribution<double> u(-1, 1);
    while (true) {
      Vec3 const x = Vec3{u(random), u(random), u(random)} * (reach * shape.bounding_radius);
      if (norm(x) <= reach * shape.bounding_radius) return x;
    }
  }
};

TEST_P(ShapeKinds, IsValid) { EXPECT_EQ(problems(library), std::vector<std::string>{}); }

TEST_P(ShapeKinds, GradientIsTheDerivativeOfPhi) {
  double const h = 1e-6;
  int off = 0, n = 0;
  for (int i = 0; i < 300; ++i) {
    Vec3 const x = draw(1.05);
    if (norm(x) < 0.1) continue;  // the radial distance bends ever more towards its centre
    ++n;
    Vec3 gradient, difference;
    evaluate_reference(library, shape, x, &gradient);
    for (int k = 0; k < 3; ++k) {
      Vec3 plus = x, minus = x;
      plus[k] += h, minus[k] -= h;
      difference[k] = (evaluate_reference(library, shape, plus) - evaluate_reference(library, shape, minus)) / (2 * h);
    }
    off += norm(gradient - difference) > 1e-5;
  }
  EXPECT_LE(off, n / 100);  // kinks: medial axes, faces of grid cells
}

TEST_P(ShapeKinds, FastAndSurfacePhiAgreeWithTheReference) {
  std::vector<Vec3> x;
  for (int i = 0; i < 500; ++i) x.push_back(draw(1.05));
  std::vector<double> fast(x.size()), again(x.size()), surface(x.size());
  std::vector<Vec3> gradient(x.size());
  fast_phi(library, shape)(x, fast, gradient);
  fast_phi(library, shape, 2)(x, again, {});
  surface_phi(library, shape)(x, surface, {});
  EXPECT_EQ(fast, again);
  for (std::size_t i = 0; i < x.size(); ++i) {
    Vec3 slope;
    double const phi = evaluate_reference(library, shape, x[i], &slope);
    EXPECT_NEAR(fast[i], phi, shape.is_net() ? 1e-5 : 0);
    EXPECT_LT(norm(gradient[i] - slope), shape.is_net() ? 1e-4 : 1e-15);
    if (std::abs(phi) > 1e-4) {
      EXPECT_EQ(surface[i] > 0, phi > 0);
    }
  }
}

// What culling relies on: no solid outside box and ball, and from outside |phi| / L never exceeds the distance.
TEST_P(ShapeKinds, BoundsHold) {
  ZeroSet const set = find_zero_set(surface_phi(library, shape), {1.08 * shape.bounding_radius, 28, 0});
  double const slack = 2e-3;  // what scenes add to boxes that come from sampled zero sets
  for (Vec3 v : set.mesh.vertex) {
    EXPECT_LE(norm(v), shape.bounding_radius + 1e-6);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(v[k], shape.box.min[k] - slack);
      EXPECT_LE(v[k], shape.box.max[k] + slack);
    }
  }
  std::vector<Vec3> const& vertex = set.mesh.vertex;
  double closest_to_bound = 0;
  for (int i = 0; i < 400; ++i) {
    Vec3 const x = draw(1.08);
    double const phi = evaluate_reference(library, shape, x);
    if (phi >= 0) continue;
    double nearest = 1e300;
    for (Vec3 v : vertex) nearest = std::min(nearest, norm(x - v));
    closest_to_bound = std::max(closest_to_bound, -phi / shape.lipschitz / nearest);
    EXPECT_LE(-phi / shape.lipschitz, nearest + 1e-9);
  }
  EXPECT_GT(closest_to_bound, 0.4) << "the Lipschitz bound is so loose that it culls nothing";
}

TEST_P(ShapeKinds, MassIsThatOfTheZeroSet) {
  ZeroSet const set = find_zero_set(surface_phi(library, shape), {1.08 * shape.bounding_radius, 28, 0});
  MeshMass const mass = zero_set_mass(surface_phi(library, shape), set);
  // Baked grids keep the mass of what they were made from; 24 cells move the surface by 1e-3.
  double const tolerance = kind == "grid" ? 2e-2 : 2e-3;
  EXPECT_NEAR(shape.volume, std::numbers::pi / 6, 1e-6);
  EXPECT_NEAR(mass.volume / shape.volume, 1, tolerance);
  EXPECT_NEAR(mass.area / shape.area, 1, kind == "box" || kind == "mesh" ? 1e-2 : tolerance);
  EXPECT_LT(norm(mass.centroid), tolerance);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mass.inertia.row[k][k] / shape.inertia[k], 1, 2 * tolerance);
  EXPECT_NEAR(mass.inertia.row[0].y, 0, 1e-3 * shape.inertia.x);
}

TEST_P(ShapeKinds, NodesStandOnTheZeroSetAndCloseIt) {
  SurfaceNodes const nodes = make_surface_nodes(library, shape, 400);
  Vec3 sum;
  double area = 0, worst = 0;
  for (int i = 0; i < nodes.n_surface; ++i) {
    worst = std::max(worst, std::abs(evaluate_reference(library, shape, nodes.position[i])));
    sum += nodes.normal[i] * nodes.area[i];
    area += nodes.area[i];
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_LT(norm(sum) / area, 1e-10);
  // A node on an edge has the bisecting normal and so less area than lies on it: a tenth at 400 nodes on a box.
  EXPECT_NEAR(area / shape.area, 1, kind == "box" || kind == "mesh" ? 0.15 : 0.02);
  EXPECT_LT(nodes.largest_gap, 0.02);  // 400 nodes: 0.8 % of d on a sphere
}

TEST_P(ShapeKinds, ComesBackFromAModelFileAsItWas) {
  std::filesystem::path const file =
      std::filesystem::temp_directory_path() / ("scree_kind_" + kind + std::to_string(::getpid()) + ".h5");
  write_model(file, library, true);
  Library const back = read_model(file);
  std::filesystem::remove(file);
  ASSERT_EQ(back.shape.size(), 1u);
  Shape const& s = back.shape[0];
  EXPECT_EQ(s.kind, shape.kind);
  EXPECT_EQ(s.bounding_radius, shape.bounding_radius);
  EXPECT_EQ(s.lipschitz, shape.lipschitz);
  for (int i = 0; i < 200; ++i) {
    Vec3 const x = draw(1.1);
    EXPECT_EQ(evaluate_reference(back, s, x), evaluate_reference(library, shape, x));
  }
}

// A baked evaluator has the phi of its source up to the size of its cells.
TEST_P(ShapeKinds, BakedEvaluatorsStayCloseToTheirSource) {
  Library const grid = bake_grid(library, shape, 40), mesh = bake_mesh(library, shape, 12);
  EXPECT_EQ(problems(grid), std::vector<std::string>{});
  EXPECT_EQ(problems(mesh), std::vector<std::string>{});
  bool const sharp = kind == "box" || kind == "mesh" || kind == "superellipsoid";
  double const cell = grid.shape[0].bounding_radius / 20;
  int near = 0, far = 0;
  for (int i = 0; i < 1500; ++i) {
    Vec3 const x = draw(1.0);
    double const phi = evaluate_reference(library, shape, x);
    double const on_grid = evaluate_reference(grid, grid.shape[0], x);
    // Interpolation misses 3 cell^2 / 8 R of a curved phi and up to 3 / 8 of a cell where three faces meet.
    if (std::abs(phi) < cell) {
      ++near;
      far += std::abs(on_grid - phi) > (sharp ? 0.4 : 0.2) * cell;
    }
    // The mesh gives true distances; phi does so for formulas and meshes only.
    double const by_mesh = evaluate_reference(mesh, mesh.shape[0], x);
    if (std::abs(phi) > 0.25 * cell) {
      EXPECT_EQ(by_mesh > 0, phi > 0);
    }
    if (shape.kind == ShapeKind::analytic) {
      EXPECT_NEAR(by_mesh, phi, 0.25 * cell);
    }
  }
  EXPECT_GT(near, 80);
  EXPECT_LE(far, near / 50);  // medial axes close to the surface
  EXPECT_EQ(grid.shape[0].volume, shape.volume);
  EXPECT_EQ(mesh.shape[0].inertia, shape.inertia);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ShapeKinds, ::testing::ValuesIn(all_kinds),
                         [](auto const& info) { return info.param; });

TEST(ShapeProblems, NameTheBrokenPart) {
  auto const complaint = [](Library const& library) {
    std::string text;
    for (std::string const& p : problems(library)) text += p + "\n";
    return text;
  };
  Library harmonics = library_of_kind("harmonics");
  harmonics.harmonics[0].pop_back();
  EXPECT_NE(complaint(harmonics).find("harmonics 0: 24 coefficients"), std::string::npos) << complaint(harmonics);
  harmonics = library_of_kind("harmonics");
  harmonics.harmonics[0][2] = 3;
  EXPECT_NE(complaint(harmonics).find("star-shaped"), std::string::npos) << complaint(harmonics);
  Library mesh = library_of_kind("mesh");
  mesh.shape[0].data = 1;
  EXPECT_NE(complaint(mesh).find("shape 'mesh': mesh 1 does not exist (there are 1)"), std::string::npos);
  SdfGrid cut = *library_of_kind("grid").grid[0];
  cut.value[0] = 1;
  Library grid = library_of_kind("grid");
  grid.grid[0] = std::make_shared<SdfGrid const>(cut);
  EXPECT_NE(complaint(grid).find("grid 0: phi is positive on a face"), std::string::npos) << complaint(grid);
  cut.value.pop_back();
  grid.grid[0] = std::make_shared<SdfGrid const>(cut);
  EXPECT_NE(complaint(grid).find("size does not match"), std::string::npos) << complaint(grid);
}

TEST(MeshShape, RefusesWhatBoundsNoSolidWithTheRepair) {
  TriangleMesh open = l_prism();
  open.triangle.pop_back();
  Library library;
  try {
    add_mesh_shape(library, "open", open);
    FAIL() << "an open mesh became a shape";
  } catch (std::invalid_argument const& e) {
    EXPECT_NE(std::string(e.what()).find("open along 3 edges"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("scree-shape import"), std::string::npos) << e.what();
  }
  EXPECT_TRUE(library.mesh.empty() && library.shape.empty());
}

// At this size recovering the corners of a cube folds one of them, and points beyond it were inside.
TEST(BakeMesh, PointsBeyondACornerAreOutside) {
  Library cube;
  cube.shape = {builtin_shape("box:1:1:1")};
  Library const mesh = bake_mesh(cube, cube.shape[0], 16);
  Vec3 const half = cube.shape[0].analytic.half_size;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-0.15, 0.15);
  for (int corner = 0; corner < 8; ++corner)
    for (int i = 0; i < 1000; ++i) {
      Vec3 const x = multiply(half, {corner & 1 ? 1.0 : -1, corner & 2 ? 1.0 : -1, corner & 4 ? 1.0 : -1}) +
                     Vec3{u(random), u(random), u(random)};
      double const truth = evaluate_reference(cube, cube.shape[0], x);
      EXPECT_NEAR(evaluate_reference(mesh, mesh.shape[0], x), truth,
                  0.03);  // less than half a cell: an edge may be cut
    }
}

TEST(HarmonicShape, OfASphereIsTheSphere) {
  Library library;
  add_harmonic_shape(library, "ball", {7.3});  // any radius: it is normalised
  Shape const& s = library.shape[0];
  EXPECT_NEAR(s.bounding_radius, 0.5, 3e-4);
  EXPECT_NEAR(s.inertia.x, std::numbers::pi / 60, 1e-6);
  EXPECT_NEAR(s.lipschitz, 1, 1e-12);
  EXPECT_NEAR(evaluate_reference(library, s, {0.1, 0.2, -0.2}), 0.2, 1e-6);
}

}  // namespace
}  // namespace scree
