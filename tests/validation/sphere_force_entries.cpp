// sphere_force_entries.cpp: rows 12 and 13 of the book: forces of node-covered spheres at fixed poses against closed
// forms, and how they converge with the number of nodes.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/contacts.h"
#include "core/simulation_impl.h"
#include "shapes/harmonic_shape.h"
#include "shapes/model_file.h"
#include "shapes/support_points.h"
#include "tests/support/cases.h"
#include "tests/support/scratch_folder.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

std::vector<Quat> random_orientations(int n) {
  std::mt19937 random(7);
  std::normal_distribution<double> u;
  std::vector<Quat> out;
  for (int i = 0; i < n; ++i) out.push_back(normalized(Quat{u(random), u(random), u(random), u(random)}));
  return out;
}

struct Spread {
  double mean = 0, worst = 0;  // worst: largest distance from 1
};
Spread spread_of(std::vector<double> const& ratio) {
  Spread out;
  for (double r : ratio) {
    out.mean += r / static_cast<double>(ratio.size());
    out.worst = std::max(out.worst, std::abs(r - 1));
  }
  return out;
}

// A sphere given by its radius, as a model file: harmonics of degree 0.
void write_round_harmonics(std::filesystem::path const& file) {
  Library library;
  add_harmonic_shape(library, "ball", {1.0});
  write_model(file, library, true);
}

// Forces between pairs of spheres of radius r at overlap delta over the closed form, in many orientations.
struct PairForces {
  Spread ratio;
  double surface = 0;  // mean distance of the body's zero set from the sphere [m]
};
PairForces pair_forces(Case c, std::string const& shape, Evaluator evaluator, int nodes, double r, double delta,
                       double closed_form) {
  int constexpr pairs = 40;
  std::vector<Quat> const turn = random_orientations(2 * pairs);
  GrainsCase g = grains_at(shape, {}, 2 * r, nodes);
  g.evaluator = evaluator;
  for (int i = 0; i < pairs; ++i)
    for (int side = 0; side < 2; ++side) {
      g.insert.position.push_back({0.05 * i, 0, side * (2 * r - delta)});
      g.insert.quaternion.push_back(turn[2 * i + side]);
    }
  g.count = 2 * pairs;
  c.grains = {g};
  Simulation s(c, {});
  std::vector<double> ratio;
  for (PairResult const& p : s.impl().work.result)
    if (p.active > 0) ratio.push_back(std::abs(p.elastic.force_on_a.z) / closed_form);
  ratio.resize(pairs, 0);  // a pair without contact carries nothing
  PairForces out;
  out.ratio = spread_of(ratio);
  Scene const& scene = s.impl().scene;
  std::vector<Vec3> const way = quasi_uniform_directions(500);
  for (Vec3 const& n : way)
    out.surface += std::abs(evaluate_reference(scene.library, scene.library.shape[0], n * 0.5)) * 2 * r / 500;
  return out;
}

TEST(Validation, Row12TwoSpheresNodeRefinement) {
  Entry book("validation", "12", "two spheres of R 5 mm, Winkler, node refinement",
             "closed form: (pi / 2) R kappa delta^2 = 78.5 N");
  ScratchFolder folder("scree_row12");
  write_round_harmonics(folder.path / "ball.h5");
  double const r = 5e-3, kappa = 1e12, delta = 1e-4, expected = M_PI / 2 * r * kappa * delta * delta;
  // The same integral without delta << R: pressure kappa (R - |x|) over the cap inside the partner, one ring a radius.
  double const apart = 2 * r - delta;
  double const exact = 2 * M_PI * r * kappa / apart / (2 * apart) *
                       ((apart * apart - r * r) * delta * delta / 2 +
                        (r * r * delta * delta / 2 - 2 * r * std::pow(delta, 3) / 3 + std::pow(delta, 4) / 4));
  Case c = rock_case();
  c.contact[0].kappa = kappa;
  c.library = {{"round", folder.path / "ball.h5"}};
  std::vector<int> counts = {250, 1000, 4000, 16000};
  if (full()) counts.push_back(64000);
  for (int nodes : counts) {
    Spread const all = pair_forces(c, "ellipsoid:1:1:1", Evaluator::net, nodes, r, delta, expected).ratio;
    std::string const what = ", " + std::to_string(nodes) + " nodes";
    book.point("force [N] against nodes", nodes, expected, all.mean * expected);
    book.point("largest relative error of 40 pairs against nodes", nodes, 0, all.worst);
    if (nodes < counts[counts.size() - 2]) {
      book.trend("force, mean of 40 pairs" + what, "N", all.mean * expected);
      book.trend("largest relative error of 40 pairs" + what, "", all.worst);
    } else {
      book.relative("force, mean of 40 pairs" + what, "N", expected, all.mean * expected, 0.02);
      book.relative("the same against the integral without delta << R" + what, "N", exact, all.mean * expected, 0.01);
      book.absolute("largest relative error of 40 pairs" + what, "", 0, all.worst, nodes >= 16000 ? 0.02 : 0.05);
    }
  }
  // Other versions of the body: their surfaces are off by what they are baked with, and F goes with delta^2: both
  // bodies' share of the overlap counts twice.
  struct {
    char const* name;
    char const* shape;
    Evaluator evaluator;
  } const versions[] = {{"grid", "ellipsoid:1:1:1", Evaluator::grid},
                        {"mesh", "ellipsoid:1:1:1", Evaluator::mesh},
                        {"harmonics", "round:ball", Evaluator::net}};
  for (auto const& v : versions) {
    PairForces const all = pair_forces(c, v.shape, v.evaluator, 4000, r, delta, expected);
    std::string const what = ", " + std::string(v.name) + ", 4000 nodes";
    book.relative("force, mean of 40 pairs" + what, "N", expected, all.ratio.mean * expected,
                  0.02 + 2 * 2 * all.surface / delta);
    book.at_most("mean distance of its surface from the sphere" + what, "d", all.surface / (2 * r), 5e-4);
  }
}

TEST(Validation, Row12ForceAgainstOverlap) {
  Entry book("validation", "12b", "two spheres of R 5 mm: force against overlap, 4,000 nodes",
             "closed form: (pi / 2) R kappa delta^2");
  double const r = 5e-3, kappa = 1e12;
  Case c = rock_case();
  c.contact[0].kappa = kappa;
  for (double share : {0.005, 0.01, 0.02, 0.04}) {  // of R
    double const delta = share * r, expected = M_PI / 2 * r * kappa * delta * delta;
    double const mean = pair_forces(c, "ellipsoid:1:1:1", Evaluator::net, 4000, r, delta, expected).ratio.mean;
    book.point("force [N] against overlap [m]", delta, expected, mean * expected);
    // The closed form is the first term in delta / R; the next is -delta / (3 R).
    book.relative("force at overlap " + std::to_string(share).substr(0, 5) + " R", "N", expected, mean * expected,
                  0.02 + share / 3);
  }
}

// Row 13. A ball of radius R whose cap of height h is inside the floor, moved at a fixed pose: only the contact stage
// runs. cos tau = (R - h) / R; kt is the tangential stiffness per area.
struct Ball {
  double r = 0.05, h = 0, kappa = 0, kt = 0, mu = 0.5;
  double cos_tau() const { return (r - h) / r; }
  double normal() const { return M_PI * r * kappa * h * h; }
};

struct Moved {
  double force_x = 0, torque_y = 0, torque_z = 0;  // friction on the ball, means over its orientations
  double force_z = 0;                              // elastic
};

Moved move(Ball const& ball, int nodes, Vec3 velocity, Vec3 spin, double seconds, int steps) {
  int constexpr copies = 60;
  Case c = rock_case();
  c.contact[0].kappa = ball.kappa;
  c.contact[0].tangential_ratio = ball.kt / ball.kappa;
  c.contact[0].friction = ball.mu;
  GrainsCase g = grains_at("ellipsoid:1:1:1", {}, 2 * ball.r, nodes);
  g.insert.quaternion = random_orientations(copies);
  for (int i = 0; i < copies; ++i) g.insert.position.push_back({0.3 * i, 0, ball.r - ball.h});
  g.count = copies;
  c.grains = {g};
  c.wall = {floor_at(0)};
  Simulation s(c, {});
  Simulation::Impl& i = s.impl();
  for (int k = 0; k < copies; ++k) {
    i.state.velocity[k] = velocity;
    i.state.angular_momentum[k] = spin * i.scene.inertia[k].x;  // a ball: all moments are alike
  }
  for (int k = 0; k < steps; ++k)
    evaluate_contacts(i.queue, i.scene, i.effects, i.contacts, seconds / steps, i.state, i.work);
  Moved out;
  for (int k = 0; k < copies; ++k) {
    out.force_x += i.state.wrench.friction[k].force.x / copies;
    out.torque_y += i.state.wrench.friction[k].torque.y / copies;
    out.torque_z += i.state.wrench.friction[k].torque.z / copies;
    out.force_z += i.state.wrench.elastic[k].force.z / copies;
  }
  return out;
}

TEST(Validation, Row13BallOnAPlaneConvergesInNodes) {
  Entry book("validation", "13", "node-covered ball on a plane: normal, stick, slip, twist, roll",
             "closed forms over the cap: pi R kappa h^2; 2 pi R h kt v t; mu F_n; "
             "2 pi R^4 kt w t (2/3 - cos tau + cos^3 tau / 3); pi R h^2 kt w t");
  Ball ball;
  ball.h = 0.01 * ball.r, ball.kappa = 2.5e10, ball.kt = 0.5 * ball.kappa;
  double const c = ball.cos_tau(), r = ball.r, h = ball.h, area = 2 * M_PI * r * h;
  // Short ways, so that nothing slips: the least pressure is at the rim, where it is 0; a rim of 1e-3 of the cap slips
  // when mu kappa h 1e-3 = kt way.
  double const way = 1e-3 * ball.mu * ball.kappa * h / ball.kt, angle = way / r;
  std::vector<int> counts = {1000, 4000, 16000};
  if (full()) counts.push_back(64000);
  for (int nodes : counts) {
    bool const finest = nodes >= 16000;
    std::string const what = ", " + std::to_string(nodes) + " nodes";
    auto const judge = [&](char const* name, char const* unit, double expected, double measured) {
      book.point(std::string(name) + ", measured over closed form against nodes", nodes, 1, measured / expected);
      // The mean of 60 orientations; a single one of 1,000 nodes has 5 in the cap.
      book.relative(name + what, unit, expected, measured, finest ? 0.01 : nodes == 4000 ? 0.02 : 0.04);
    };
    double const seconds = 1e-3;
    Moved const slid = move(ball, nodes, {way / seconds, 0, 0}, {}, seconds, 4);
    judge("normal force", "N", ball.normal(), slid.force_z);
    judge("stick, tangential force", "N", area * ball.kt * way, -slid.force_x);
    double const far = 4 * ball.mu * ball.kappa * h / ball.kt;
    Moved const slipped = move(ball, nodes, {far / seconds, 0, 0}, {}, seconds, 40);
    judge("slip, tangential force", "N", ball.mu * ball.normal(), -slipped.force_x);
    book.relative("slip over the ball's own normal force" + what, "", ball.mu, -slipped.force_x / slipped.force_z,
                  1e-9);
    Moved const twisted = move(ball, nodes, {}, {0, 0, angle / seconds}, seconds, 4);
    judge("twist, torque", "N m", 2 * M_PI * std::pow(r, 4) * ball.kt * angle * (2.0 / 3 - c + c * c * c / 3),
          -twisted.torque_z);
    // Rolling about y with v = w R: nodes above the lowest point lag by w R (1 - cos theta).
    Moved const rolled = move(ball, nodes, {r * angle / seconds, 0, 0}, {0, angle / seconds, 0}, seconds, 4);
    judge("roll, tangential force", "N", M_PI * r * h * h * ball.kt * angle, -rolled.force_x);
  }
}

}  // namespace
}  // namespace scree::book
