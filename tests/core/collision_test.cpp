// collision_test.cpp: two-body frictionless collisions conserve momenta and kinetic energy (validation row 8), for
// analytic shapes, the shipped networks and a deliberately warped phi; and the meter notices a normalised gradient.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "core/simulation_impl.h"
#include "shapes/certify_phi.h"
#include "shapes/model_file.h"
#include "shapes/normalise.h"
#include "tests/support/cases.h"

namespace scree {
namespace {

using namespace testing;

struct Collision {
  double momentum = 0, angular_momentum = 0, kinetic = 0;  // relative changes
  double overlap = 0;                                      // peak [d]
};

struct Encounter {
  std::string shape_a, shape_b;
  std::filesystem::path library;  // empty: built-in shapes
  unsigned seed = 0;              // of the poses
  double speed = 1;               // of each grain [m/s]
  bool normalise_gradient = false;
  NodeStorage storage_a = NodeStorage::explicit_, storage_b = NodeStorage::explicit_;
};

Case collision_case(Encounter const& setup) {
  std::mt19937 random(setup.seed);
  std::uniform_real_distribution<double> u(-1, 1);
  Case c = rock_case();
  if (!setup.library.empty()) c.library = {{"grains", setup.library}};
  GrainsCase a = grains_at(setup.shape_a, {{-0.1, 0.01 * u(random), 0.01 * u(random)}});
  GrainsCase b = grains_at(setup.shape_b, {{0.1, 0, 0}});
  for (GrainsCase* g : {&a, &b}) g->insert.quaternion = {normalized(Quat{u(random), u(random), u(random), u(random)})};
  b.name = "other";
  a.storage = setup.storage_a, b.storage = setup.storage_b;
  a.insert.velocity = {setup.speed, 0, 0};
  b.insert.velocity = {-setup.speed, 0.1 * setup.speed, 0};
  c.grains = {a, b};
  c.time.end = 0.25 / setup.speed;
  return c;
}

void total_momenta(Simulation::Impl const& s, Vec3& linear, Vec3& angular) {
  linear = angular = {};
  for (int i = 0; i < 2; ++i) {
    Vec3 const p = s.state.velocity[i] * s.scene.mass[i];
    linear += p;
    angular += s.state.angular_momentum[i] + cross(s.state.position[i], p);
  }
}

Collision collide(Encounter const& setup) {
  Simulation s(collision_case(setup), {});
  Simulation::Impl& impl = s.impl();
  impl.contacts.normalise_gradient = setup.normalise_gradient;
  Vec3 p0, l0, p1, l1;
  total_momenta(impl, p0, l0);
  double const k0 = impl.report.kinetic_total;
  Collision out;
  while (s.step() == RunState::running) {
    out.overlap = std::max(out.overlap, s.largest_overlap());
    if (out.overlap > 0 && s.largest_overlap() == 0 && norm(impl.state.position[0] - impl.state.position[1]) > 0.16)
      break;
  }
  EXPECT_EQ(s.largest_overlap(), 0) << "still in contact: prolong the run";
  total_momenta(impl, p1, l1);
  double const scale = impl.scene.mass[0] * setup.speed;
  out.momentum = norm(p1 - p0) / scale;
  out.angular_momentum = norm(l1 - l0) / (scale * 0.1);
  out.kinetic = std::abs(impl.report.kinetic_total / k0 - 1);
  return out;
}

TEST(Collision, AnalyticShapesConserveMomentaAndEnergy) {
  for (char const* shape : {"ellipsoid:1:0.8:0.6", "ellipsoid:1:0.5:0.5", "superellipsoid:1:0.8:0.7:0.6"})
    for (unsigned seed = 0; seed < 4; ++seed) {
      Collision const r = collide({shape, shape, "", seed});
      EXPECT_GT(r.overlap, 1e-3);
      EXPECT_LT(r.momentum, 1e-10);
      EXPECT_LT(r.angular_momentum, 1e-10);
      EXPECT_LT(r.kinetic, 1e-4) << shape << " " << seed;
    }
}

TEST(Collision, ShippedGrainsConserveMomentaAndEnergyInTwentyPoses) {
  std::filesystem::path const file = std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5";
  Library const library = read_model(file);
  ASSERT_EQ(library.shape.size(), 20u);
  double worst = 0, deepest = 0, shallowest = 1;
  for (unsigned pose = 0; pose < 20; ++pose) {
    std::string const a = "grains:" + library.shape[pose].name, b = "grains:" + library.shape[(7 * pose + 3) % 20].name;
    Collision const r = collide({a, b, file, pose, 2});
    EXPECT_LT(r.momentum, 1e-10) << a << " " << b;
    EXPECT_LT(r.angular_momentum, 1e-10) << a << " " << b;
    EXPECT_LT(r.kinetic, 3e-4) << a << " " << b;
    worst = std::max(worst, r.kinetic);
    deepest = std::max(deepest, r.overlap);
    shallowest = std::min(shallowest, r.overlap);
  }
  printf("20 poses: kinetic energy to %.2g, peak overlap %.2g .. %.2g d\n", worst, shallowest, deepest);
  EXPECT_GT(deepest, 0.02);
}

// Nodes kept as 16-bit radii, against their like and against arrays: the contact energy is that of the nodes as they
// are stored, so nothing is lost to their rounding.
TEST(Collision, CompactGrainsConserveMomentaAndEnergy) {
  std::filesystem::path const file = std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5";
  double worst = 0;
  for (unsigned pose = 0; pose < 4; ++pose) {
    char const* const shape[4] = {"grains:ballast/0", "grains:sand/1", "grains:ellipsoid/4", "grains:ballast/3"};
    Encounter setup{shape[pose], shape[(pose + 1) % 4], file, pose, 2};
    setup.storage_a = NodeStorage::compact;
    if (pose != 1) setup.storage_b = NodeStorage::compact;
    Collision const r = collide(setup);
    EXPECT_GT(r.overlap, 1e-3);
    EXPECT_LT(r.momentum, 1e-10);
    EXPECT_LT(r.angular_momentum, 1e-10);
    EXPECT_LT(r.kinetic, 3e-4) << setup.shape_a << " " << setup.shape_b;
    worst = std::max(worst, r.kinetic);
  }
  printf("compact grains: kinetic energy to %.2g\n", worst);
}

TEST(Collision, TheGateRefusesAGradientOutsideTheCasesLimits) {
  Case c = collision_case(
      {"grains:ballast/0", "grains:cobble/0", std::filesystem::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"});
  c.limits.gradient_low = 0.95;
  try {
    Simulation(c, {});
    FAIL() << "ballast's |grad phi| of about 0.8 at its edges passed a limit of 0.95";
  } catch (InputError const& e) {
    ASSERT_EQ(e.problems.size(), 1u);
    EXPECT_NE(e.problems[0].find("ballast/0"), std::string::npos) << e.problems[0];
    EXPECT_NE(e.problems[0].find("limits.gradient"), std::string::npos) << e.problems[0];
  }
}

// phi(x) = c - sum_i a_i softplus(n_i . x - h): convex and smooth, but |grad phi| runs from about 0.5 to 1.5.
std::filesystem::path write_warped_model() {
  int const width = 24;
  Mlp net;
  net.activation = Activation::softplus;
  net.parameter = 12;
  net.width = {3, width, 1};
  net.weight = {std::vector<float>(3 * width), std::vector<float>(width)};
  net.bias = {std::vector<float>(width, -0.15f), {0.55f}};
  for (int i = 0; i < width; ++i) {
    double const z = 1 - 2 * (i + 0.5) / width, r = std::sqrt(1 - z * z), turn = 2.399963 * i;
    double const n[3] = {r * std::cos(turn), r * std::sin(turn), z};
    for (int k = 0; k < 3; ++k) net.weight[0][k * width + i] = static_cast<float>(n[k]);
    net.weight[1][i] = static_cast<float>(-0.25 - 0.2 * n[0] - 0.1 * n[2]);
  }
  Library library;
  library.net = {net};
  Shape shape;
  shape.name = "warped";
  shape.kind = ShapeKind::net;
  shape.net = 0;
  library.shape = {shape};
  normalise_net(library, 0, 2.0);
  certify_phi(library, library.shape[0], {2000, 1000, 1}, library.shape[0].certificate);  // the gate wants it
  std::filesystem::path const file = std::filesystem::temp_directory_path() / "scree_warped_test.h5";
  write_model(file, library, true);
  return file;
}

TEST(Collision, OnAWarpedPhiTheExactGradientConservesAndTheNormalisedOneDoesNot) {
  std::filesystem::path const file = write_warped_model();
  Library const library = read_model(file);
  double low = 10, high = 0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  for (int i = 0; i < 300; ++i) {
    Vec3 gradient;
    double const phi = evaluate_reference(library, library.shape[0], {u(random), u(random), u(random)}, &gradient);
    if (std::abs(phi) > 0.02) continue;
    low = std::min(low, norm(gradient));
    high = std::max(high, norm(gradient));
  }
  EXPECT_GT(high / low, 1.5) << "the test's phi is not warped";
  double exact = 0, normalised = 0;
  for (unsigned pose = 0; pose < 5; ++pose) {
    Encounter setup{"grains:warped", "grains:warped", file, pose, 2};
    Collision const good = collide(setup);
    EXPECT_LT(good.momentum, 1e-10);
    exact = std::max(exact, good.kinetic);
    setup.normalise_gradient = true;
    normalised = std::max(normalised, collide(setup).kinetic);
  }
  printf("warped phi, |grad| %.2f .. %.2f: kinetic energy to %.2g exact, %.2g normalised\n", low, high, exact,
         normalised);
  EXPECT_LT(exact, 3e-4);
  EXPECT_GT(normalised, 3e-3);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace scree
