// test_certify_mesh.cpp: a shape laid onto a mesh of any pose and unit, and its errors against it.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "shapes/analytic_shapes.h"
#include "shapes/mesh/certify_mesh.h"
#include "shapes/mesh/icosphere.h"
#include "shapes/mesh/procedural_grains.h"
#include "shapes/mesh_normalise.h"
#include "shapes/mesh_shape.h"

namespace scree {
namespace {

BodyFrame some_frame() {
  BodyFrame frame;
  frame.rotation = to_matrix(normalized(Quat{0.3, -0.7, 0.4, 0.5}));
  frame.shift = {12, -7, 3};
  frame.scale = 25;
  return frame;
}

// The mesh as a shape of a library, and the same mesh somewhere else.
struct Pair {
  Library library;
  TriangleMesh elsewhere;
};
Pair pair_of(TriangleMesh const& mesh, BodyFrame const& frame) {
  Pair pair;
  add_mesh_shape(pair.library, "body", mesh);
  pair.elsewhere = pair.library.mesh[0]->mesh();
  for (Vec3& v : pair.elsewhere.vertex) v = frame.to_body(v);
  return pair;
}

TEST(Align, FindsWhereAnAngularGrainLies) {
  BodyFrame const frame = some_frame();
  Pair const p = pair_of(procedural_grain(GrainKind::ballast, 1).mesh, frame);
  Shape const& shape = p.library.shape[0];
  Alignment const found = align_shape(surface_phi(p.library, shape), p.elsewhere);
  EXPECT_LT(found.rms, 1e-6);
  // No symmetry: one frame only. The distance is exact, so Gauss and Newton end at the optimum to rounding.
  EXPECT_NEAR(found.frame.scale, frame.scale, 1e-5 * frame.scale);
  for (Vec3 const x : {Vec3{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}})
    EXPECT_NEAR(norm(found.frame.to_body(x) - frame.to_body(x)), 0, 1e-5 * frame.scale);
}

TEST(Align, TurnsBodiesWithLikeMoments) {
  // A square prism: two moments agree, so the principal axes may lie anywhere about the third.
  Library library;
  Shape box = builtin_shape("box:1:1:0.5");
  box.name = "box";
  library.shape.push_back(box);
  Vec3 const h = box.analytic.half_size;
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertex.push_back({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
  mesh.triangle = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  BodyFrame frame = some_frame();
  for (Vec3& v : mesh.vertex) v = frame.to_body(v);
  EXPECT_LT(align_shape(surface_phi(library, library.shape[0]), mesh).rms, 1e-6);
}

TEST(Align, AnotherBodyStaysFarOff) {
  Pair const p = pair_of(procedural_grain(GrainKind::ballast, 1).mesh, some_frame());
  EXPECT_GT(align_shape(surface_phi(p.library, p.library.shape[0]), procedural_grain(GrainKind::sand, 4).mesh).rms,
            0.02);
}

TEST(MeshTruth, MeasuresASphereAgainstItsTriangles) {
  // An icosphere of 5,120 triangles inscribed in a sphere: its volume is short by a share s, and the sphere that fits
  // its surface best lies between its corners and its faces: the errors stay below the height of the caps.
  Library library;
  library.shape.push_back(builtin_shape("sphere"));
  TriangleMesh mesh = icosphere(4);
  for (Vec3& v : mesh.vertex) v = v * 10 + Vec3{3, 4, 5};
  MeshTruth const truth(mesh, library, library.shape[0], 1);
  Certificate c;
  truth.certify(fast_phi(library, library.shape[0]), library.shape[0], 2000, 1, c);
  double longest = 0;
  for (auto const& t : mesh.triangle)
    for (int k = 0; k < 3; ++k) longest = std::max(longest, norm(mesh.vertex[t[k]] - mesh.vertex[t[(k + 1) % 3]]) / 20);
  double const cap = longest * longest / 3 / (2 * 0.5);  // a^2 / 3 / (2 R): an equilateral triangle's middle [d]
  EXPECT_GT(c.max, 0);
  EXPECT_LT(c.max, cap);
  EXPECT_LT(c.band_max, cap);
  EXPECT_LT(c.hausdorff, cap);
  EXPECT_LT(c.volume_error, 6 * cap);    // 3 cap / R, R = d / 2
  EXPECT_LT(c.inertia_error, 10 * cap);  // 5 cap / R
  EXPECT_NEAR(c.flat_share, 1, 0);
}

TEST(MeshTruth, SeesAVolumeThatIsWrong) {
  // The shape claims a volume 4 % above what its phi encloses.
  Pair p = pair_of(procedural_grain(GrainKind::cobble, 0).mesh, some_frame());
  Shape& shape = p.library.shape[0];
  shape.volume *= 1.04;
  MeshTruth const truth(p.elsewhere, p.library, shape, 1);
  Certificate c;
  truth.certify(fast_phi(p.library, shape), shape, 200, 1, c);
  EXPECT_NEAR(c.volume_error, 0.04, 1e-4);
  EXPECT_LT(c.inertia_error, 1e-4);
  EXPECT_LT(c.max, 1e-5);
}

TEST(MeshTruth, RefusesWhatBoundsNoSolid) {
  Library library;
  library.shape.push_back(builtin_shape("sphere"));
  TriangleMesh mesh = icosphere(1);
  mesh.triangle.pop_back();
  EXPECT_THROW(MeshTruth(mesh, library, library.shape[0], 1), std::invalid_argument);
}

}  // namespace
}  // namespace scree
