// test_mesh_evaluator.cpp: the engine's mesh distance against CGAL's on the procedural grains, convex and not.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh/procedural_grains.h"
#include "shapes/mesh_tree.h"

namespace scree {
namespace {

TEST(MeshEvaluator, AgreesWithTheExactDistanceInValueSignAndGradient) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  for (ProceduralGrain const& grain : {procedural_grain(GrainKind::ballast, 2), procedural_grain(GrainKind::cobble, 1),
                                       procedural_grain(GrainKind::sand, 4)}) {
    MeshTree const ours(grain.mesh);
    MeshDistance const truth(grain.mesh);
    int turned = 0;
    for (int i = 0; i < 300; ++i) {
      Vec3 const x{u(random), u(random), u(random)};
      Vec3 gradient;
      double const phi = mesh_distance(ours.sdf(), x, &gradient);
      MeshDistance::Sample const exact = truth.at(x);
      EXPECT_NEAR(phi, exact.phi, 1e-12) << grain.name;
      turned += norm(gradient - exact.gradient) > 1e-6;
    }
    EXPECT_LE(turned, 1) << grain.name;  // on the medial axis either side is right
  }
}

}  // namespace
}  // namespace scree
