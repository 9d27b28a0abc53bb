// impact_entries.cpp: rows 1 to 4 of the book: the impacts of Chung & Ooi (2011), spheres in Hertz's closed form.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

char const* const source = "Chung & Ooi, Granul. Matter 13 (2011) 643, test ";

struct Material {
  char const* name;
  double youngs, poisson, density;  // [Pa], [-], [kg/m3]
};

// A sphere that meets its like or a rigid plane head-on, by Hertz: energy m_e v^2/2 = (8/15) E* sqrt(R) overlap^5/2;
// contact lasts 2 x 1.4716 overlap / v (Johnson, Contact mechanics (1985), eq. 11.24).
struct HertzImpact {
  double e_star, radius, mass, speed;  // effective [Pa], [m], [kg]; closing speed [m/s]

  double overlap() const { return std::pow(15 * mass * speed * speed / (16 * e_star * std::sqrt(radius)), 0.4); }
  double force(double x) const { return 4.0 / 3 * e_star * std::sqrt(radius) * std::pow(x, 1.5); }
  double duration() const { return 2.9433 * overlap() / speed; }
};

double ball_mass(double density, double r) { return density * 4.0 / 3 * M_PI * r * r * r; }

// With rigid: the case's E* is that of two like bodies, so a rigid plane takes twice the sphere's E.
Case hertz_case(Material const& m, bool rigid) {
  Case c = rock_case();
  c.material[0].density = m.density;
  c.contact[0].law = ContactLaw::hertz;
  c.contact[0].youngs_modulus = rigid ? 2 * m.youngs : m.youngs;
  c.contact[0].poisson_ratio = m.poisson;
  return c;
}

// A ball 1e-3 of its radius above a plane.
Case ball_on_plane(Material const& m, double radius, Vec3 velocity) {
  Case c = hertz_case(m, true);
  c.grains = {grains_at("sphere", {{0, 0, 1.001 * radius}}, 2 * radius)};
  c.grains[0].insert.velocity = velocity;
  c.wall = {floor_at(0)};
  return c;
}

HertzImpact impact_on_plane(Material const& m, double radius, double speed) {
  return {m.youngs / (1 - m.poisson * m.poisson), radius, ball_mass(m.density, radius), speed};
}

// 2,000 steps a contact: its length is known to a step at either end, 1e-3.
void set_step(Case& c, HertzImpact const& h, double gap) {
  c.time.step = h.duration() / 2000;
  c.time.end = gap / h.speed + 3 * h.duration();
}

struct Peak {
  double force, overlap, duration;  // [N], [m], [s]
};

void add_impact(Entry& book, Material const& m, Case const& c, HertzImpact const& h, Peak const& published) {
  Simulation s(c, {});
  double force = 0, overlap = 0;
  int touching = 0;
  while (s.step() == RunState::running) {
    if (s.impl().work.result.empty()) break;  // they have parted
    PairResult const& pair = s.impl().work.result[0];
    force = std::max(force, norm(pair.elastic.force_on_a));
    overlap = std::max(overlap, pair.overlap);
    touching += pair.overlap > 0;
    if (pair.overlap > 0 && touching % 50 == 0)
      book.point(fmt::format("force [N] against overlap [m], {}", m.name), pair.overlap, h.force(pair.overlap),
                 norm(pair.elastic.force_on_a));
  }
  double const duration = touching * *c.time.step;
  auto const row = [&](char const* what, char const* unit, double closed, double printed, double measured) {
    book.relative(fmt::format("{}: {}, Hertz's formula", m.name, what), unit, closed, measured, 0.01);
    book.relative(fmt::format("{}: {}, as published", m.name, what), unit, printed, measured, 0.01);
  };
  row("peak force", "N", h.force(h.overlap()), published.force, force);
  row("peak overlap", "m", h.overlap(), published.overlap, overlap);
  row("contact lasts", "s", h.duration(), published.duration, duration);
}

TEST(Validation, Row1TwoSpheresMeet) {
  Entry book("validation", "1", "two elastic spheres meet at 10 m/s each (Hertz)", std::string(source) + "1");
  double const r = 0.01, v = 10;
  auto const meet = [&](Material const& m, Peak const& published) {
    Case c = hertz_case(m, false);
    GrainsCase a = grains_at("sphere", {{-1.001 * r, 0, 0}}, 2 * r),
               b = grains_at("sphere", {{1.001 * r, 0, 0}}, 2 * r);
    b.name = "other";
    a.insert.velocity = {v, 0, 0};
    b.insert.velocity = {-v, 0, 0};
    c.grains = {a, b};
    HertzImpact const h{m.youngs / (2 * (1 - m.poisson * m.poisson)), r / 2, ball_mass(m.density, r) / 2, 2 * v};
    set_step(c, h, 2e-3 * r);
    add_impact(book, m, c, h, published);
  };
  meet({"glass", 48e9, 0.20, 2800}, {10.70e3, 274.1e-6, 40.3e-6});
  meet({"limestone", 20e9, 0.25, 2500}, {7.11e3, 368.3e-6, 54.2e-6});
}

TEST(Validation, Row2SphereMeetsARigidPlane) {
  Entry book("validation", "2", "elastic sphere on a rigid plane at 0.2 m/s (Hertz)", std::string(source) + "2");
  double const r = 0.1, v = 0.2;
  auto const meet = [&](Material const& m, Peak const& published) {
    Case c = ball_on_plane(m, r, {0, 0, -v});
    HertzImpact const h = impact_on_plane(m, r, v);
    set_step(c, h, 1e-3 * r);
    add_impact(book, m, c, h, published);
  };
  meet({"aluminium", 70e9, 0.30, 2699}, {11.37e3, 49.7e-6, 732e-6});
  meet({"magnesium", 40e9, 0.35, 1800}, {7.23e3, 52.1e-6, 767e-6});
}

// Of tests 3 and 4: alumina, r 2.5 mm, 3.9 m/s. Neither result depends on its constants.
Material const alumina{"alumina", 380e9, 0.23, 4000};
double constexpr small_radius = 2.5e-3, impact_speed = 3.9;  // [m], [m/s]

TEST(Validation, Row3ReboundIsTheRestitution) {
  Entry book("validation", "3", "sphere on a plane at 3.9 m/s rebounds with e", std::string(source) + "3");
  for (double e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    Case c = ball_on_plane(alumina, small_radius, {0, 0, -impact_speed});
    if (e < 1) c.contact[0].restitution = e;
    HertzImpact const h = impact_on_plane(alumina, small_radius, impact_speed);
    set_step(c, h, 1e-3 * small_radius);
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    double const rebound = s.frame().velocity[0].z / impact_speed;
    book.relative(fmt::format("rebound over impact speed, e = {}", e), "", e, rebound, 0.01);
    book.point("rebound over impact speed [-] against e asked for [-]", e, e, rebound);
  }
}

// Angles are between the velocity and the normal. Above 32.5 degrees, tan = 7/2 mu (1 + e), the contact slides all the
// while: its tangential impulse is mu (1 + e) m v_n. Below, the result depends on the tangential stiffness: reported.
TEST(Validation, Row4ObliqueImpact) {
  Entry book("validation", "4", "oblique impact of a sphere at 3.9 m/s, friction 0.092, e 0.98",
             std::string(source) + "4; closed form in gross sliding");
  double const mu = 0.092, e = 0.98;
  for (double degrees : {5., 10., 20., 30., 35., 40., 50., 60., 70., 80., 85.}) {
    double const angle = degrees * M_PI / 180, vn = impact_speed * std::cos(angle), vt = impact_speed * std::sin(angle);
    Case c = ball_on_plane(alumina, small_radius, {vt, 0, -vn});
    HertzImpact const h = impact_on_plane(alumina, small_radius, vn);
    c.contact[0].friction = mu;
    c.contact[0].restitution = e;
    c.contact[0].at_overlap = h.overlap() / (2 * small_radius);  // tangential stiffness by Mindlin, at the peak
    c.contact[0].tangential_ratio = 2 * (1 - alumina.poisson) / (2 - alumina.poisson);
    set_step(c, h, 1e-3 * small_radius);
    Simulation s(c, {});
    while (s.step() == RunState::running) {
    }
    double const kept = s.frame().velocity[0].x / vt, spin = s.frame().spin[0].y;
    bool const slides = std::tan(angle) > 3.5 * mu * (1 + e);
    double const expected_kept = slides ? 1 - mu * (1 + e) * vn / vt : std::nan("");
    double const expected_spin = slides ? 5 * mu * (1 + e) * vn / (2 * small_radius) : std::nan("");
    std::string const at = fmt::format("at {} degrees", degrees);
    if (slides) {
      book.relative("tangential speed kept " + at, "", expected_kept, kept, 0.02);
      book.relative("spin " + at, "rad/s", expected_spin, spin, 0.02);
    } else {
      book.trend("tangential speed kept " + at, "", kept);
      book.trend("spin " + at, "rad/s", spin);
    }
    book.point("tangential speed kept [-] against angle from the normal [deg]", degrees, expected_kept, kept);
    book.point("spin [rad/s] against angle from the normal [deg]", degrees, expected_spin, spin);
  }
}

}  // namespace
}  // namespace scree::book
