// test_projection.cpp: surface projection against closed forms, on warped phi, on shipped grains, and where it must
// fail.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "shapes/analytic_shapes.h"
#include "shapes/model_file.h"
#include "shapes/projection.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

double constexpr tolerance = 1e-9;

ProjectionOptions with(ProjectionMethod method, double radius = INFINITY) {
  ProjectionOptions o;
  o.method = method;
  o.tolerance = tolerance;
  o.radius = radius;
  return o;
}

// Uniform in the cube [-half, half]^3, away from the centre.
std::vector<Vec3> cloud(int count, double half, double least = 0.05) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-half, half);
  std::vector<Vec3> x;
  while (static_cast<int>(x.size()) < count) {
    Vec3 const p{uniform(random), uniform(random), uniform(random)};
    if (norm(p) > least) x.push_back(p);
  }
  return x;
}

PhiBatch field(std::function<double(Vec3, Vec3*)> value) {
  return [value](Span<const Vec3> x, Span<double> phi, Span<Vec3> gradient) {
    for (int i = 0; i < x.size(); ++i) phi[i] = value(x[i], gradient.empty() ? nullptr : &gradient[i]);
  };
}

// The ellipsoid's true distance times a smooth factor between 1/2 and 2: same surface, |grad phi| 1/2 .. 2 on it.
PhiBatch warped(AnalyticSdf const& body) {
  return field([body](Vec3 x, Vec3* gradient) {
    double const e = std::sin(5 * x.x + 1) * std::cos(7 * x.y) * std::cos(3 * x.z), w = std::exp2(e);
    Vec3 const slope{5 * std::cos(5 * x.x + 1) * std::cos(7 * x.y) * std::cos(3 * x.z),
                     -7 * std::sin(5 * x.x + 1) * std::sin(7 * x.y) * std::cos(3 * x.z),
                     -3 * std::sin(5 * x.x + 1) * std::cos(7 * x.y) * std::sin(3 * x.z)};
    double const phi = signed_distance(body, x, gradient);
    if (gradient) *gradient = *gradient * w + slope * (w * std::log(2.0) * phi);
    return w * phi;
  });
}

TEST(Projection, SphereByBothMethodsIsTheRadialPoint) {
  Shape const sphere = make_sphere();
  Library const library;
  std::vector<Vec3> const query = cloud(500, 1);
  for (auto method : {ProjectionMethod::gradient, ProjectionMethod::ray}) {
    Projection const p = project(reference_phi(library, sphere), query, with(method));
    for (std::size_t i = 0; i < query.size(); ++i) {
      ASSERT_TRUE(p.converged(static_cast<int>(i)));
      EXPECT_LE(p.iterations[i], 1);  // phi is linear along the normal, which is the ray
      EXPECT_NEAR(norm(p.position[i] - normalized(query[i]) * 0.5), 0, 2e-9);
    }
  }
}

TEST(Projection, GradientDescentFindsTheClosestPointOfAnEllipsoid) {
  Shape const body = make_ellipsoid({1, 0.7, 0.4});
  Vec3 const a = body.analytic.half_size;
  Library const library;
  PhiBatch const phi = reference_phi(library, body);
  std::vector<Vec3> query;
  for (Vec3 x : cloud(1000, 1))  // outside: inside, the distance has a medial axis
    if (signed_distance(body.analytic, x, nullptr) < 0) query.push_back(x);
  Projection const p = project(phi, query, with(ProjectionMethod::gradient));
  ASSERT_GT(query.size(), 500u);
  for (std::size_t i = 0; i < query.size(); ++i) {
    ASSERT_TRUE(p.converged(static_cast<int>(i)));
    Vec3 const x = p.position[i], normal = normalized(divide(divide(x, a), a)), away = query[i] - x;
    EXPECT_NEAR(norm(away), -signed_distance(body.analytic, query[i], nullptr), 1e-7);
    EXPECT_NEAR(norm(cross(away, normal)), 0, 1e-7);  // the closed form's own error leaves 1e-8 sideways
  }
}

TEST(Projection, RaySearchHitsTheRaysIntersection) {
  Shape const body = make_ellipsoid({1, 0.7, 0.4});
  Vec3 const a = body.analytic.half_size;
  std::vector<Vec3> const query = cloud(1000, 1);
  Library const library;
  for (PhiBatch const& phi : {reference_phi(library, body), warped(body.analytic)}) {
    Projection const p = project(phi, query, with(ProjectionMethod::ray, 1.5));
    for (std::size_t i = 0; i < query.size(); ++i) {
      ASSERT_TRUE(p.converged(static_cast<int>(i)));
      Vec3 const n = normalized(query[i]);
      double const hit = 1 / norm(divide(n, a));
      // phi changes along the ray by at least half (the warp) of the cosine between ray and normal, here > 0.6.
      EXPECT_NEAR(norm(p.position[i] - n * hit), 0, tolerance / 0.3);
    }
    EXPECT_LT(summary(p).mean_iterations, 8);
  }
}

TEST(Projection, WarpedPhiConvergesByGradientToo) {
  Shape const body = make_ellipsoid({1, 0.7, 0.4});
  std::vector<Vec3> const query = cloud(1000, 0.8);
  Projection const p = project(warped(body.analytic), query, with(ProjectionMethod::gradient));
  int failed = 0;
  for (std::size_t i = 0; i < query.size(); ++i) {
    EXPECT_TRUE(is_finite(p.position[i]));
    if (!p.converged(static_cast<int>(i))) {
      ++failed;  // far out the factor's slope may outweigh the distance's: |phi| has minima of its own there
      EXPECT_LT(signed_distance(body.analytic, query[i], nullptr), -0.15);
      continue;
    }
    EXPECT_NEAR(signed_distance(body.analytic, p.position[i], nullptr), 0, 2 * tolerance);  // the factor is >= 1/2
  }
  EXPECT_LT(failed, 100);
}

TEST(Projection, ShippedGrainsMeetTheToleranceWithinTheirBall) {
  Library const library = read_model(std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5");
  std::vector<Vec3> const direction = quasi_uniform_directions(300);
  for (Shape const& shape : library.shape) {
    double const ball = 1.1 * shape.bounding_radius;
    std::vector<Vec3> query;
    for (std::size_t i = 0; i < direction.size(); ++i) query.push_back(direction[i] * (i % 2 ? 0.25 : 1.3 * ball));
    bool left_the_ball = false;
    PhiBatch const phi = [&, fast = fast_phi(library, shape)](Span<const Vec3> x, Span<double> value, Span<Vec3> g) {
      for (Vec3 p : x) left_the_ball |= norm(p) > ball * (1 + 1e-12);
      fast(x, value, g);
    };
    for (auto method : {ProjectionMethod::gradient, ProjectionMethod::ray}) {
      ProjectionOptions o = with(method, ball);
      o.tolerance = 2e-6;  // float
      Projection const p = project(phi, query, o);
      ProjectionSummary const s = summary(p);
      EXPECT_EQ(s.failures(), 0) << shape.name << ": " << to_string(s);
      EXPECT_LT(s.worst_phi, o.tolerance);
      EXPECT_LT(s.mean_iterations, 6) << shape.name << ": " << to_string(s);
      for (std::size_t i = 0; i < query.size(); ++i) {
        if (method == ProjectionMethod::ray) {
          EXPECT_NEAR(norm(cross(p.position[i], direction[i])), 0, 1e-12);
        }
        EXPECT_NEAR(evaluate_reference(library, shape, p.position[i]), 0, 1e-5);  // what the float network may err
      }
    }
    EXPECT_FALSE(left_the_ball) << shape.name;
  }
}

TEST(Projection, RayThatGrazesTheSurfaceGoesOn) {
  // |phi| falls to 1e-5 at r = 0.3 without changing sign: steps of phi would crawl past.
  PhiBatch const grazing = field([](Vec3 x, Vec3*) {
    double const r = norm(x);
    return (0.5 - r) * ((r - 0.3) * (r - 0.3) + 5e-5);
  });
  Projection const p = project(grazing, std::vector<Vec3>{{0.1, 0, 0}}, with(ProjectionMethod::ray, 1));
  EXPECT_TRUE(p.converged(0)) << to_string(p.outcome[0]);
  EXPECT_NEAR(p.position[0].x, 0.5, tolerance / 0.04);  // the slope there is (0.5 - 0.3)^2
}

TEST(Projection, FailuresAreNamedAndFinite) {
  PhiBatch const cone = field([](Vec3 x, Vec3* g) {  // a sphere's distance, without direction at the centre
    double const r = norm(x);
    if (g) *g = r > 0 ? x / -r : Vec3{};
    return 0.5 - r;
  });
  PhiBatch const outside = field([](Vec3 x, Vec3* g) {  // no solid anywhere; |phi| is least at the origin
    if (g) *g = x * -2;
    return -1 - norm2(x);
  });
  std::vector<Vec3> const query{{0, 0, 0}, {0.1, 0, 0}, {NAN, 0, 0}};
  for (auto method : {ProjectionMethod::gradient, ProjectionMethod::ray}) {
    Projection const p = project(cone, query, with(method));
    EXPECT_EQ(p.outcome[0], ProjectionOutcome::no_direction);
    EXPECT_TRUE(p.position[0] == Vec3{});
    EXPECT_EQ(p.outcome[1], ProjectionOutcome::converged);
    EXPECT_EQ(p.outcome[2], ProjectionOutcome::not_finite);
    EXPECT_EQ(to_string(summary(p)), "3 points, 0.3 iterations (at most 1), 2 failed: 1 no direction, 1 not finite");
  }
  std::vector<Vec3> const off{{0.4, 0, 0}};
  EXPECT_EQ(project(outside, off, with(ProjectionMethod::ray)).outcome[0], ProjectionOutcome::no_surface);
  ProjectionOutcome const end = project(outside, off, with(ProjectionMethod::gradient)).outcome[0];
  EXPECT_TRUE(end == ProjectionOutcome::stalled || end == ProjectionOutcome::no_direction) << to_string(end);
  // A solid that fills the ball: the ray leaves it without a crossing.
  PhiBatch const full = field([](Vec3, Vec3*) { return 0.3; });
  EXPECT_EQ(project(full, off, with(ProjectionMethod::ray, 1)).outcome[0], ProjectionOutcome::no_surface);
  PhiBatch const broken = field([](Vec3, Vec3*) { return NAN; });
  EXPECT_EQ(project(broken, off, with(ProjectionMethod::ray)).outcome[0], ProjectionOutcome::not_finite);
  EXPECT_EQ(project(cone, {}, {}).position.size(), 0u);
}

TEST(Projection, ToleranceIterationsAndLambdaAreHonoured) {
  Shape const body = make_ellipsoid({1, 0.7, 0.4});
  PhiBatch const phi = warped(body.analytic);
  std::vector<Vec3> const query = cloud(300, 0.6);
  for (auto method : {ProjectionMethod::gradient, ProjectionMethod::ray}) {
    ProjectionOptions o = with(method, 1.5);
    double before = 0;
    for (double t : {1e-2, 1e-5, 1e-9}) {
      o.tolerance = t;
      ProjectionSummary const s = summary(project(phi, query, o));
      EXPECT_LT(s.worst_phi, t);
      EXPECT_GT(s.mean_iterations, before);
      before = s.mean_iterations;
    }
    o.max_iterations = 1;
    Projection const cut = project(phi, query, o);
    for (int n : cut.iterations) EXPECT_LE(n, 1);
    EXPECT_GT(summary(cut).count[static_cast<int>(ProjectionOutcome::iterations)], 100);
  }
  // Algorithm 2 with lambda on a distance that is linear along the ray: the first step leaves a share 1 - lambda.
  ProjectionOptions o = with(ProjectionMethod::ray);
  o.lambda = 0.25;
  o.max_iterations = 1;
  Library const library;
  Shape const sphere = make_sphere();
  Projection const p = project(reference_phi(library, sphere), std::vector<Vec3>{{0.9, 0, 0}}, o);
  EXPECT_NEAR(p.phi[0], 0.75 * -0.4, 1e-12);
  for (double bad : {0.0, -1.0, 3.0, std::nan("")}) {
    o.lambda = bad;
    EXPECT_THROW(project(phi, query, o), std::invalid_argument);
  }
  o = {};
  o.tolerance = 0;
  EXPECT_THROW(project(phi, query, o), std::invalid_argument);
}

TEST(Projection, SameBitsForAnyThreadsAndAnyCompany) {
  Library const library = read_model(std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5");
  Shape const& shape = library.shape[0];
  std::vector<Vec3> const query = cloud(1000, 0.8);
  for (auto method : {ProjectionMethod::gradient, ProjectionMethod::ray}) {
    ProjectionOptions o = with(method, 1.1 * shape.bounding_radius);
    o.tolerance = 1e-6;
    Projection const one = project(fast_phi(library, shape, 1), query, o);
    Projection const three = project(fast_phi(library, shape, 3), query, o);
    Projection const some = project(fast_phi(library, shape, 1), Span<const Vec3>(query).subspan(100, 7), o);
    for (std::size_t i = 0; i < query.size(); ++i) {
      ASSERT_TRUE(one.position[i] == three.position[i]);
      ASSERT_EQ(one.iterations[i], three.iterations[i]);
    }
    for (int i = 0; i < 7; ++i) EXPECT_TRUE(some.position[i] == one.position[100 + i]);
  }
}

}  // namespace
}  // namespace scree
