// friction_entries.cpp: rows 7b and 7c of the book: tangential springs turn with their pair; sliding takes Coulomb's
// impulse.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/contacts.h"
#include "kernels/tangential.h"
#include "tests/support/cases.h"
#include "tests/validation/entries.h"

namespace scree::book {

using namespace testing;

namespace {

double constexpr turn = 2.25 * 2 * M_PI;  // [rad]

struct Axis {
  char const* name;
  Vec3 direction;
};
// The pair's normal is along z.
Axis const axes[] = {
    {"the normal", {0, 0, 1}}, {"a tangent", {0, 1, 0}}, {"an oblique axis", normalized(Vec3{1, 2, 3})}};

}  // namespace

void history_turns_with_the_pair(Entry& book, Transport const& transport) {
  int const steps = 9000;
  for (Axis const& axis : axes) {
    Vec3 const n{0, 0, 1}, start{1e-4, 0, 0};
    Vec3 xi = start;
    Mat3 const step = to_matrix(quat_from_rotation_vector(axis.direction * (turn / steps)));
    for (int i = 1; i <= steps; ++i) {
      Vec3 const turned = to_matrix(quat_from_rotation_vector(axis.direction * (turn * i / steps))) * n;
      xi = transport(xi, step, turned);
    }
    Vec3 const expected = to_matrix(quat_from_rotation_vector(axis.direction * turn)) * start;
    book.relative(fmt::format("length of the stretch, about {}", axis.name), "m", norm(start), norm(xi), 1e-6);
    book.at_most(fmt::format("distance from the turned stretch, of its length, about {}", axis.name), "",
                 norm(xi - expected) / norm(start), 1e-6);
  }
}

namespace {

// Two grains side by side in z, sheared while they overlap, then turned as one rigid body about their middle: the
// friction force of the whole contact has to turn with them. Poses and velocities are prescribed.
void sheared_pair_turns(Entry& book, std::string const& name, std::string const& shape) {
  double const d = 0.1, apart = 0.99 * d;  // an overlap of 1 % d
  Case c = rock_case();
  c.contact[0].friction = 10;  // sticks
  GrainsCase a = grains_at(shape, {{0, 0, apart / 2}}, d, 500), b = grains_at(shape, {{0, 0, -apart / 2}}, d, 500);
  b.name = "other";
  c.grains = {a, b};
  for (Axis const& axis : axes) {
    Simulation s(c, {});
    Simulation::Impl& impl = s.impl();
    double const dt = 1e-5;
    // In the frame that turns with the pair a moves along x by 1e-4 d in the first step; then nothing moves in it.
    auto const evaluate = [&](double angle, double rate, double shear) {
      Quat const q = quat_from_rotation_vector(axis.direction * angle);
      Mat3 const r = to_matrix(q);
      for (int i : {0, 1}) {
        impl.state.orientation[i] = q;
        impl.state.position[i] = r * Vec3{0, 0, (i == 0 ? 1 : -1) * apart / 2};
        impl.state.velocity[i] = cross(axis.direction * rate, impl.state.position[i]);
        impl.state.angular_momentum[i] =
            r * multiply(impl.scene.inertia[i], transposed_times(r, axis.direction * rate));
      }
      impl.state.velocity[0] += r * Vec3{shear, 0, 0};
      evaluate_contacts(impl.queue, impl.scene, impl.effects, impl.contacts, dt, impl.state, impl.work);
      return impl.work.result.at(0).friction.force_on_a;
    };
    evaluate(0, 0, 1e-4 * d / dt);
    Vec3 const before = evaluate(0, 0, 0);
    int const steps = 4500;
    Vec3 after;
    for (int i = 1; i <= steps; ++i) after = evaluate(turn * i / steps, turn / steps / dt, 0);
    Vec3 const expected = to_matrix(quat_from_rotation_vector(axis.direction * turn)) * before;
    std::string const what = fmt::format("{} turned about {}: ", name, axis.name);
    book.at_least(what + "friction force that was there", "N", norm(before), 1);
    book.relative(what + "size of the friction force", "N", norm(before), norm(after), 1e-6);
    book.at_most(what + "distance from the turned force, of its size", "", norm(after - expected) / norm(before), 1e-6);
  }
}

TEST(Validation, Row7bHistoryTurnsWithThePair) {
  Entry book("validation", "7b", "a stuck pair turned rigidly 2.25 times keeps its friction force", "closed form");
  history_turns_with_the_pair(book, transport);
  sheared_pair_turns(book, "spheres in closed form", "sphere");
  sheared_pair_turns(book, "spheres with nodes", "ellipsoid:1:1:1");
}

TEST(Validation, Row7cSlidingImpactTakesCoulombsImpulse) {
  Entry book("validation", "7c", "oblique impact in full sliding, zeta 0.7", "closed form: impulse mu (1 + e) m v_n");
  double const mu = 0.1, vn = 1, vt = 3;
  for (Evaluator evaluator : {Evaluator::analytic, Evaluator::grid, Evaluator::mesh}) {
    Case c = rock_case();
    c.contact[0].friction = mu;
    c.contact[0].damping_ratio = 0.7;
    GrainsCase g = grains_at("ellipsoid:1:1:1", {{0, 0, 0.0501}}, 0.1, 4000);
    g.insert.velocity = {vt, 0, -vn};
    g.evaluator = evaluator;
    c.grains = {g};
    c.wall = {floor_at(0)};
    c.time.end = 0.02;
    c.time.safety = 0.05;
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    std::string const as = ", sphere as " + evaluator_name(evaluator);
    double const e = s.frame().velocity[0].z / vn;
    book.relative("tangential impulse over m v_n" + as, "", mu * (1 + e), (vt - s.frame().velocity[0].x) / vn, 5e-3);
    book.at_most("ledger residual of the energy moved" + as, "", std::abs(s.ledger().residual) / s.ledger().moved,
                 1e-3);
  }
}

}  // namespace
}  // namespace scree::book
