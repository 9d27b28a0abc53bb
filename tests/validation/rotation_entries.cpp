// rotation_entries.cpp: rows 9 and 10 of the book: a free body flips about its middle axis, another one precesses.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

// One free body with these principal moments [kg m2] and spin [rad/s], its axes along the world's.
std::unique_ptr<Simulation> free_body(Vec3 inertia, Vec3 spin, double step, double end) {
  Case c = rock_case();
  c.grains = {grains_at("ellipsoid:1:0.8:0.6", {{0, 0, 0}}, 0.1, 32)};
  c.time.step = step;
  c.time.end = end;
  c.output.every = end;
  auto s = std::make_unique<Simulation>(c, SimulationOptions{});
  s->impl().scene.inertia[0] = inertia;
  s->impl().state.angular_momentum[0] = multiply(inertia, spin);
  return s;
}

Vec3 spin_in_body(Simulation& s) {
  return transposed_times(to_matrix(s.impl().state.orientation[0]), s.frame().spin[0]);
}

// omega_2 of a free body is an elliptic sine (Landau & Lifshitz, Mechanics, section 37, for L^2 > 2 E I_2): the times
// of its first zero and between two zeros [s]. omega_2 starts positive and rising.
struct Flips {
  double first, between;
};
Flips flips_of(Vec3 i, Vec3 w) {
  double const energy2 = dot(w, multiply(i, w)), l2 = norm2(multiply(i, w));
  double const rate = std::sqrt((i.z - i.y) * (l2 - energy2 * i.x) / (i.x * i.y * i.z));
  double const k = std::sqrt((i.y - i.x) * (energy2 * i.z - l2) / ((i.z - i.y) * (l2 - energy2 * i.x)));
  double const start = w.y * std::sqrt(i.y * (i.z - i.y) / (energy2 * i.z - l2));
  double const quarter = std::comp_ellint_1(k);
  return {(2 * quarter - std::ellint_1(k, std::asin(start))) / rate, 2 * quarter / rate};
}

// The energy error is of second order in the step and bounded: 1e6 steps have no more of it than 1e4.
TEST(Validation, Row9DzhanibekovFlip) {
  Entry book("validation", "9", "free rotation about the middle axis, moments 1, 2, 3",
             "closed form: elliptic functions, Landau & Lifshitz, Mechanics, section 37");
  Vec3 const inertia{1, 2, 3}, start{1e-3, 1, 1e-3};
  Flips const expected = flips_of(inertia, start);
  double const step = 1e-2;
  int const steps = full() ? 1000000 : 10000, period = static_cast<int>(std::ceil(2 * expected.between / step));
  auto const body = free_body(inertia, start, step, step * steps);
  Simulation& s = *body;
  Vec3 const l0 = multiply(inertia, start);
  double const e0 = 0.5 * dot(start, l0);
  std::vector<double> flips;
  double before = start.y, energy_drift = 0, momentum_drift = 0;
  double early_drift = 0, late_drift = 0;  // of the energy, over a whole period each
  for (int k = 1; k <= steps; ++k) {
    s.step();
    Vec3 const w = spin_in_body(s), l = to_matrix(s.impl().state.orientation[0]) * multiply(inertia, w);
    if (before * w.y < 0) flips.push_back(k * step - step * w.y / (w.y - before));
    before = w.y;
    double const drift = std::abs(0.5 * dot(w, multiply(inertia, w)) / e0 - 1);
    energy_drift = std::max(energy_drift, drift);
    if (k <= period) early_drift = std::max(early_drift, drift);
    if (k > steps - period) late_drift = std::max(late_drift, drift);
    momentum_drift = std::max(momentum_drift, norm(l - l0) / norm(l0));
    if (k <= 10000 && k % 50 == 0) book.point("omega_2 [rad/s] against time [s]", k * step, std::nan(""), w.y);
  }
  if (flips.size() < 3) flips.resize(3, std::nan(""));
  book.relative("first sign change of omega_2", "s", expected.first, flips[0], 1e-3);
  book.relative("from the first to the second", "s", expected.between, flips[1] - flips[0], 1e-3);
  book.relative("from the second to the third", "s", expected.between, flips[2] - flips[1], 1e-3);
  book.at_most("largest drift of the energy", "", energy_drift, 1e-6);
  book.at_most("largest drift of the angular momentum", "", momentum_drift, 1e-6);
  // It does not grow: what differs is where in a flip the steps happen to lie.
  book.at_most("drift of the energy in the last period over that of the first", "", late_drift / early_drift, 1.01);
  book.trend("steps", "", steps);
}

TEST(Validation, Row10Precession) {
  Entry book("validation", "10", "an axisymmetric body precesses", "closed form: L / I_perp");
  for (double along : {0.5, 2.0}) {  // long and flat: moment about the axis over that across it
    Vec3 const inertia{1, 1, along}, start{0.3, 0, 1};
    Vec3 const l = multiply(inertia, start), up = normalized(l);
    Vec3 const x = normalized(Vec3{0, 0, 1} - up * up.z), y = cross(up, x);
    double const rate = norm(l) / inertia.x, step = 2e-3, turns = 10;
    int const steps = static_cast<int>(std::lround(turns * 2 * M_PI / rate / step));
    auto const body = free_body(inertia, start, step, step * steps);
    Simulation& s = *body;
    double angle = 0, before = 0, nutation = 0;
    for (int k = 1; k <= steps; ++k) {
      s.step();
      Vec3 const axis = to_matrix(s.impl().state.orientation[0]) * Vec3{0, 0, 1};
      double const now = std::atan2(dot(axis, y), dot(axis, x));
      angle += std::remainder(now - before, 2 * M_PI);
      before = now;
      nutation = std::max(nutation, std::abs(dot(axis, up) - up.z));
    }
    std::string const what = along < 1 ? ", long body" : ", flat body";
    book.relative("rate over ten turns" + what, "rad/s", rate, angle / (steps * step), 1e-3);
    book.absolute("change of the cosine between axis and L" + what, "", 0, nutation, 1e-3);
  }
}

}  // namespace
}  // namespace scree::book
