// restitution_entries.cpp: row 7a of the book: the damping ratio alone decides the restitution of node contacts.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/support/cases.h"
#include "tests/validation/entries.h"

namespace scree::book {

using namespace testing;

double rebound(Rebound const& r, Flaw const& flaw) {
  double const d = 0.1;
  Case c = rock_case();
  c.contact[0].damping_ratio = r.zeta;
  GrainsCase g = grains_at(r.shape, {{0, 0, (r.reach + 1e-3) * d}}, d, r.nodes);
  g.insert.velocity = {0, 0, -r.speed};
  g.evaluator = r.evaluator;
  c.grains = {g};
  c.wall = {floor_at(0)};
  c.time.end = 1;
  c.time.safety = 0.1;
  Simulation s(c, {});
  flaw.start(s);
  bool touched = false;
  while (flaw.step(s) == RunState::running) {
    touched = touched || s.largest_overlap() > 0;
    if (touched && s.largest_overlap() == 0) break;
  }
  return s.frame().velocity[0].z / r.speed;
}

// Of the full speed, not of e: the row asks for 2 % at 1,000 nodes, and e goes down to 0.14.
double constexpr tolerance = 0.02;

void add_rebound(Entry& book, std::string const& what, Rebound const& r, Flaw const& flaw) {
  double const e = rebound(r, flaw);
  book.absolute(fmt::format("e at zeta {}, {}", r.zeta, what), "", r.expected, e, tolerance);
  book.point("restitution [-] against damping ratio [-], " + what, r.zeta, r.expected, e);
}

namespace {

// Design table of the smooth impact under Winkler's law in which every node clips at zero by itself; kernels_test holds
// the integral of kernels/restitution.h to it.
std::map<double, double> const table = {{.1, .726}, {.2, .556}, {.3, .440}, {.4, .357}, {.5, .296},
                                        {.6, .249}, {.7, .213}, {.8, .184}, {1.0, .141}};

TEST(Validation, Row7aRestitutionAgainstDampingRatio) {
  Entry book("validation", "7a", "restitution depends on the damping ratio alone",
             "smooth impact integrated in one dimension");
  for (auto const& [zeta, e] : table) add_rebound(book, "sphere at 1 m/s", {.zeta = zeta, .expected = e});
  double const long_axis = 0.5 * std::cbrt(25.0);  // of an ellipsoid 5:1:1 with volume pi/6 [d]
  for (double zeta : {0.1, 0.4, 0.7, 1.0}) {
    double const e = table.at(zeta);
    add_rebound(book, "sphere at 0.3 m/s", {.zeta = zeta, .expected = e, .speed = 0.3});
    add_rebound(book, "sphere at 3 m/s", {.zeta = zeta, .expected = e, .speed = 3});
    add_rebound(book, "250 nodes at 3 m/s", {.zeta = zeta, .expected = e, .speed = 3, .nodes = 250});
    add_rebound(book, "4,000 nodes at 3 m/s", {.zeta = zeta, .expected = e, .speed = 3, .nodes = 4000});
    add_rebound(book, "5:1 ellipsoid on its tip", {"ellipsoid:1:1:5", long_axis, zeta, e});
    add_rebound(book, "5:1 ellipsoid on its flank", {"ellipsoid:5:1:1", long_axis / 5, zeta, e});
  }
  for (Evaluator evaluator : {Evaluator::grid, Evaluator::mesh})
    add_rebound(book, "sphere as " + evaluator_name(evaluator) + ", 3 m/s", {.speed = 3, .evaluator = evaluator});
}

}  // namespace
}  // namespace scree::book
