// test_zero_set.cpp: the surface of phi as a closed mesh, its mass properties, and networks brought into our frame.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "shapes/analytic_shapes.h"
#include "shapes/normalise.h"
#include "shapes/support_points.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

double constexpr pi = std::numbers::pi;

// Every directed edge once and its reverse once: closed and consistently oriented.
bool is_closed_and_oriented(TriangleMesh const& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (auto const& t : mesh.triangle)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (auto const& [edge, count] : edges) {
    auto const reverse = edges.find({edge.second, edge.first});
    if (count != 1 || reverse == edges.end() || reverse->second != 1) return false;
  }
  return true;
}

PhiBatch from_function(double (*f)(Vec3)) {
  return [f](Span<const Vec3> x, Span<double> phi, Span<Vec3> gradient) {
    for (int n = 0; n < x.size(); ++n) {
      phi[n] = f(x[n]);
      for (int i = 0; !gradient.empty() && i < 3; ++i) {
        Vec3 up = x[n], down = x[n];
        up[i] += 1e-6;
        down[i] -= 1e-6;
        gradient[n][i] = (f(up) - f(down)) / 2e-6;
      }
    }
  };
}
double two_balls(Vec3 x) { return std::max(0.2 - norm(x - Vec3{0.3, 0, 0}), 0.25 - norm(x + Vec3{0.3, 0, 0})); }
double torus(Vec3 x) { return 0.15 - std::hypot(std::hypot(x.x, x.y) - 0.4, x.z); }
double shell(Vec3 x) { return 0.1 - std::abs(norm(x) - 0.4); }

// An ellipsoid-like body as a network of one hidden layer: with u = turn (x - centre) / size,
// phi = size (0.05 - sum over j of c_j (1 - cos u_j)).
Mlp cosine_body(Vec3 c, Mat3 const& turn, Vec3 centre, double size) {
  Mlp net;
  net.activation = Activation::sine;
  net.parameter = 1;
  net.width = {3, 3, 1};
  net.weight.assign(2, {});
  net.bias.assign(2, {});
  net.weight[0].resize(9);
  net.bias[0].resize(3);
  net.weight[1].resize(3);
  double offset = 0.05;
  for (int j = 0; j < 3; ++j) {
    // sin(u + pi/2) = cos(u)
    for (int i = 0; i < 3; ++i) net.weight[0][i * 3 + j] = static_cast<float>(turn.row[j][i] / size);
    net.bias[0][j] = static_cast<float>(pi / 2 - dot(turn.row[j], centre) / size);
    net.weight[1][j] = static_cast<float>(c[j] * size);
    offset -= c[j];
  }
  net.bias[1] = {static_cast<float>(offset * size)};
  return net;
}

TEST(ZeroSet, SphereIsClosedAndConverges) {
  Library const library;
  Shape const sphere = make_sphere();
  PhiBatch const phi = surface_phi(library, sphere);
  double previous = 0;
  for (int cells : {16, 32}) {
    ZeroSet const set = find_zero_set(phi, {0.55, cells, 1});
    EXPECT_TRUE(is_closed_and_oriented(set.mesh));
    EXPECT_EQ(set.components, 1);
    EXPECT_EQ(set.euler_characteristic, 2);
    EXPECT_LT(set.worst_phi, 1e-14);
    for (std::size_t i = 0; i < set.normal.size(); ++i) EXPECT_NEAR(dot(set.normal[i], set.mesh.vertex[i]), 0.5, 1e-12);
    MeshMass const mass = zero_set_mass(phi, set);
    double const error = std::abs(mass.volume / (pi / 6) - 1);
    EXPECT_LT(error, 2 * std::pow(set.cell, 4) / std::pow(0.5, 4));  // O(cell^4)
    EXPECT_NEAR(mass.area, pi, 10 * std::pow(set.cell, 4) / std::pow(0.5, 4));
    EXPECT_NEAR(norm(mass.centroid), 0, 1e-4 * set.cell);
    EXPECT_NEAR(mass.inertia.row[0].x, sphere.inertia.x, 3 * std::max(error, 1e-7) * sphere.inertia.x);
    if (cells == 32) {
      EXPECT_LT(error, previous / 8);
    }
    previous = error;
  }
}

TEST(ZeroSet, SkippingFarCellsChangesNothing) {
  Library const library;
  Shape const shape = make_ellipsoid({1, 0.8, 0.6});
  PhiBatch const phi = surface_phi(library, shape);
  int evaluations = 0;
  PhiBatch const counted = [&](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    evaluations += gradient.empty() ? x.size() : 0;
    phi(x, value, gradient);
  };
  ZeroSet const all = find_zero_set(counted, {1.1 * shape.bounding_radius, 80, 0});
  int const dense = std::exchange(evaluations, 0);
  ZeroSet const some = find_zero_set(counted, {1.1 * shape.bounding_radius, 80, 1});
  EXPECT_LT(evaluations, dense / 2);
  ASSERT_EQ(all.mesh.vertex.size(), some.mesh.vertex.size());
  EXPECT_EQ(all.mesh.triangle, some.mesh.triangle);
  for (std::size_t i = 0; i < all.mesh.vertex.size(); ++i) EXPECT_TRUE(all.mesh.vertex[i] == some.mesh.vertex[i]);
}

TEST(ZeroSet, AnalyticMassesAgreeWithTheirClosedForms) {
  Library const library;
  // Smooth bodies: fourth order in the cell. Pointed and sharp ones: a cell at every tip and corner is approximate.
  struct Case {
    Shape shape;
    double tolerance;
  };
  // Box: edges and corners are cut off by half a cell at most: 12 edges, cell^2 / 8 each, of which Richardson keeps
  // some.
  for (Case const& c :
       {Case{make_ellipsoid({1, 0.7, 0.5}), 1e-6}, Case{make_superellipsoid({1, 0.8, 0.6}, 0.5, 0.5), 1e-6},
        Case{make_superellipsoid({1, 0.7, 0.5}, 1.4, 0.6), 1e-5}, Case{make_box({1, 0.7, 0.5}), 1e-4}}) {
    PhiBatch const phi = surface_phi(library, c.shape);
    ZeroSet const set = find_zero_set(phi, {1.1 * c.shape.bounding_radius, 40, 1});
    EXPECT_TRUE(is_closed_and_oriented(set.mesh));
    EXPECT_EQ(set.euler_characteristic, 2);
    MeshMass const mass = zero_set_mass(phi, set);
    EXPECT_NEAR(mass.volume, pi / 6, c.tolerance) << to_string(c.shape.analytic.kind);
    EXPECT_NEAR(mass.area, c.shape.area, 10 * c.tolerance * c.shape.area);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(mass.inertia.row[i][i], c.shape.inertia[i], 2 * c.tolerance * c.shape.inertia[i]);
  }
}

TEST(ZeroSet, TopologyIsCounted) {
  ZeroSet const two = find_zero_set(from_function(two_balls), {0.6, 48, 1});
  EXPECT_EQ(two.components, 2);
  EXPECT_EQ(two.euler_characteristic, 4);
  EXPECT_NEAR(zero_set_mass(from_function(two_balls), two).volume, 4 * pi / 3 * (0.008 + 0.015625), 1e-5);
  ZeroSet const ring = find_zero_set(from_function(torus), {0.6, 48, 1});
  EXPECT_EQ(ring.components, 1);
  EXPECT_EQ(ring.euler_characteristic, 0);
  ZeroSet const hollow = find_zero_set(from_function(shell), {0.6, 48, 1});
  EXPECT_EQ(hollow.components, 2);
  EXPECT_NEAR(mesh_mass(hollow.mesh).volume, 4 * pi / 3 * (0.125 - 0.027), 5e-3);  // the void's surface faces inwards
  EXPECT_TRUE(is_closed_and_oriented(hollow.mesh));
}

TEST(ZeroSet, NothingBeyondTheBallIsSeen) {
  // A body that leaves the ball is cut by it and still closed; phi is asked inside the ball only.
  PhiBatch const slab = [](Span<const Vec3> x, Span<double> phi, Span<Vec3> gradient) {
    for (int n = 0; n < x.size(); ++n) {
      phi[n] = 0.1 - std::abs(x[n].z);
      if (gradient.empty())
        EXPECT_LE(norm(x[n]), 0.5);
      else
        gradient[n] = {0, 0, x[n].z < 0 ? 1.0 : -1.0};
    }
  };
  EXPECT_TRUE(is_closed_and_oriented(find_zero_set(slab, {0.5, 24, 1}).mesh));
  PhiBatch const nothing = from_function([](Vec3) { return -1.0; });
  EXPECT_THROW(find_zero_set(nothing, {0.5, 24, 1}), std::runtime_error);
  EXPECT_THROW(find_zero_set(nothing, {0, 24, 1}), std::invalid_argument);
  EXPECT_THROW(find_zero_set(from_function([](Vec3) { return std::nan(""); }), {0.5, 24, 0}), std::runtime_error);
}

TEST(SupportPoints, ClimbFindsTheSupportOfAnEllipsoid) {
  Library const library;
  for (Shape const& shape : {make_ellipsoid({1, 0.6, 0.4}), make_box({1, 0.7, 0.4})}) {
    PhiBatch const phi = surface_phi(library, shape);
    ZeroSet const set = find_zero_set(phi, {1.1 * shape.bounding_radius, 32, 1});
    std::vector<Vec3> const direction = quasi_uniform_directions(200, 0.3);
    std::vector<Vec3> start;
    for (int i : extreme_points(set.mesh.vertex, direction)) start.push_back(set.mesh.vertex[i]);
    std::vector<Vec3> const top = climb(phi, start, direction, set.cell);
    for (std::size_t k = 0; k < top.size(); ++k) {
      double const h = support(shape.analytic, direction[k], nullptr);
      EXPECT_NEAR(dot(top[k], direction[k]), h, set.cell / 50) << to_string(shape.analytic.kind) << " " << k;
      EXPECT_LE(dot(top[k], direction[k]), h + 1e-9);
    }
  }
}

// One network, as it is and under a shared decoder's rules, against the frame it was built in.
void expect_normalised(Library& library, int index, RawShape const& raw, Vec3 centre, Mat3 const& turn, double size) {
  Shape const& s = library.shape[index];
  EXPECT_EQ(raw.components, 1);
  EXPECT_EQ(raw.euler_characteristic, 2);
  EXPECT_NEAR(norm(raw.centroid - centre), 0, 1e-5 * size);
  EXPECT_NEAR(dot(cross(raw.axes.row[0], raw.axes.row[1]), raw.axes.row[2]), 1, 1e-12);  // proper
  // Least curvature coefficient = longest axis = x of the normalised frame, up to sign.
  EXPECT_NEAR(std::abs(dot(raw.axes.row[0], turn.row[2])), 1, 1e-4);
  EXPECT_NEAR(std::abs(dot(raw.axes.row[2], turn.row[0])), 1, 1e-4);
  EXPECT_TRUE(problems(library).empty());
  PhiBatch const phi = fast_phi(library, s);
  ZeroSet const set = find_zero_set(phi, {1.1 * s.bounding_radius, 64, s.lipschitz});
  MeshMass const mass = zero_set_mass(phi, set);
  EXPECT_NEAR(mass.volume, pi / 6, 2e-5);  // float network, 64 cells
  EXPECT_NEAR(norm(mass.centroid), 0, 1e-5);
  EXPECT_NEAR(mass.area, s.area, 1e-4 * s.area);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(mass.inertia.row[i][i], s.inertia[i], 1e-4 * s.inertia[i]);
    EXPECT_NEAR(mass.inertia.row[i][(i + 1) % 3], 0, 1e-4 * s.inertia[i]);
  }
  for (Vec3 v : set.mesh.vertex) {
    EXPECT_LE(norm(v), s.bounding_radius);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(v[i] > s.box.min[i] && v[i] < s.box.max[i]);
  }
}

TEST(NormaliseNet, VolumeCentroidAndAxesOfTheZeroSet) {
  Vec3 const centre{0.02, -0.03, 0.05}, bend{0.35, 0.3, 0.2};
  Mat3 const turn = to_matrix(normalized(Quat{0.3, 0.5, -0.4, 0.7}));
  double const size = 1.7;
  Library single;
  single.net.push_back(cosine_body(bend, turn, centre, size));
  single.shape.resize(1);
  single.shape[0].name = "a";
  single.shape[0].kind = ShapeKind::net;
  single.shape[0].net = 0;
  Library const raw_library = single;
  RawShape const raw = normalise_net(single, 0, 1.6);
  EXPECT_TRUE(single.shape[0].query.scale == 1 && single.shape[0].query.shift == Vec3{});  // folded into the layers
  expect_normalised(single, 0, raw, centre, turn, size);

  Library shared = raw_library;  // two shapes on one network: the transform must go beside it
  shared.shape.push_back(shared.shape[0]);
  shared.shape[1].name = "b";
  RawShape const raw_shared = normalise_net(shared, 1, 1.6);
  EXPECT_NE(shared.shape[1].query.scale, 1);
  EXPECT_EQ(shared.net[0].weight[0], raw_library.net[0].weight[0]);
  shared.shape[0] = shared.shape[1];
  shared.shape[0].name = "a";
  expect_normalised(shared, 1, raw_shared, centre, turn, size);

  // phi of the normalised shape is phi of the raw one, in the new frame.
  Vec3 const x{0.2, 0.1, -0.3};
  Vec3 const x_raw = transposed_times(raw.axes, x * raw.diameter) + raw.centroid;
  double const expected = evaluate_reference(raw_library, raw_library.shape[0], x_raw) / raw.diameter;
  EXPECT_NEAR(evaluate_reference(single, single.shape[0], x), expected, 1e-6);  // float weights, rounded twice
  EXPECT_NEAR(evaluate_reference(shared, shared.shape[1], x), expected, 1e-12);
}

TEST(NormaliseNet, NothingToNormaliseIsAnError) {
  Library library;
  library.net.push_back(cosine_body({0.3, 0.3, 0.3}, {}, {}, 1));
  library.net[0].bias[1][0] = -10;
  library.shape.resize(1);
  library.shape[0].kind = ShapeKind::net;
  library.shape[0].net = 0;
  EXPECT_THROW(normalise_net(library, 0, 1.0), std::runtime_error);
}

}  // namespace
}  // namespace scree
