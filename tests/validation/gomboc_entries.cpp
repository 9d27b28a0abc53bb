// gomboc_entries.cpp: row 17 of the book: a homogeneous convex body with one stable equilibrium rights itself.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/simulation_impl.h"
#include "shapes/harmonic_shape.h"
#include "shapes/harmonics_fit.h"
#include "shapes/model_file.h"
#include "shapes/support_points.h"
#include "tests/support/cases.h"
#include "tests/support/scratch_folder.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

// R(n) = 1 + beta (z cos(a x) + y sin(a x)) over the unit sphere: the height z after each point was turned about the x
// axis by the angle a x. That turn is a smooth one-to-one map of the sphere, so R has the critical points of z, two:
// its least at (0, 0, -1), its largest at (0, 0, 1). Where the body is convex and its centroid is the origin, these are
// its equilibria on a plane: one stable, one unstable, as Varkonyi & Domokos (J. Nonlinear Sci. 16 (2006) 255) showed
// to exist. By symmetry the centroid lies on the z axis; `twist` puts it into the origin: tan a = a to first order in
// beta.
double constexpr beta = 0.035;

double radius(Vec3 n, double twist) { return 1 + beta * (n.z * std::cos(twist * n.x) + n.y * std::sin(twist * n.x)); }

double centroid_height(double twist) {
  int const along = 200, around = 64;  // midpoints in x, on which a sphere's area is uniform, and about the x axis
  double volume = 0, moment = 0;
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < around; ++k) {
      double const x = (2 * i + 1.0) / along - 1, r = std::sqrt(1 - x * x), angle = 2 * M_PI * k / around;
      Vec3 const n{x, r * std::cos(angle), r * std::sin(angle)};
      double const size = radius(n, twist);
      volume += std::pow(size, 3) / 3;
      moment += std::pow(size, 4) / 4 * n.z;
    }
  return moment / volume;
}

double balanced_twist() {
  double low = 4.3, high = 4.7;  // about 4.4934; the centroid sinks as the twist grows
  while (high - low > 1e-12) (centroid_height((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return low;
}

// Least curvature over directions of the gauge |x| / R(x / |x|), which is convex where the body is. Across the radius
// it is 1 on a sphere; along the radius always 0.
double least_curvature(double twist) {
  double const h = 1e-3;
  auto const gauge = [&](Vec3 x) { return norm(x) / radius(normalized(x), twist); };
  double least = 10;
  for (Vec3 const n : quasi_uniform_directions(5000)) {
    Vec3 const e1 = normalized(cross(n, std::abs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), e2 = cross(n, e1);
    auto const second = [&](Vec3 e) { return (gauge(n + e * h) - 2 * gauge(n) + gauge(n - e * h)) / (h * h); };
    Vec3 const diagonal = (e1 + e2) * std::sqrt(0.5);
    double const xx = second(e1), yy = second(e2), xy = second(diagonal) - 0.5 * (xx + yy);
    least = std::min(least, 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy));
  }
  return least;
}

// Angles [deg] between `axis` of the body and straight down for bodies let go at these poses on a plane with friction,
// each by itself, after `end` seconds.
std::vector<double> tilts_at_the_end(GrainsCase grains, LibraryCase const& library, Vec3 axis,
                                     std::vector<Quat> const& start, double end) {
  double const d = 0.1, gravity = 9.81;
  Case c = rock_case();
  c.library = {library};
  c.gravity = Vec3{0, 0, -gravity};
  // So soft that the patch of contact, 0.1 d in radius, holds tens to hundreds of nodes: they must not carry the body
  // on bumps. The valley to the stable pole falls by 1e-3 only.
  c.contact[0].kappa = 2650 * gravity / (3 * 1e-4);  // sinks in by 0.01 d: weight = pi (d/2) kappa (0.01 d)^2
  c.contact[0].damping_ratio = 0.1;
  c.contact[0].friction = 0.5;
  c.damping = DampingCase{0.5};
  grains.insert.quaternion = start;
  for (std::size_t i = 0; i < start.size(); ++i) grains.insert.position.push_back({10 * d * i, 0, 0.52 * d});
  grains.count = static_cast<int>(start.size());
  c.grains = {grains};
  c.wall = {floor_at(0)};
  c.time.safety = 0.6;  // how it falls does not matter, where it comes to rest does
  c.time.end = end;
  Simulation s(c, {});
  while (s.step() == RunState::running) {
  }
  std::vector<double> out;
  for (Quat const& q : s.frame().orientation)
    out.push_back(180 / M_PI * std::acos(std::clamp(-(to_matrix(q) * axis).z, -1.0, 1.0)));
  return out;
}

TEST(Validation, Row17GombocRightsItself) {
  Entry book("validation", "17c", "a convex homogeneous body with one stable equilibrium rights itself",
             "Varkonyi & Domokos (2006); its radius has one minimum by construction");
  double const twist = balanced_twist();
  book.at_most("height of the centroid", "radii", std::abs(centroid_height(twist)), 1e-10);
  book.at_least("least curvature across the radius: convex", "", least_curvature(twist), 0.1);
  std::vector<Vec3> point = quasi_uniform_directions(1000);
  for (Vec3& p : point) p = p * radius(p, twist);
  HarmonicsFit const fit = fit_harmonics(point, 14);
  book.at_most("largest error of the radius as harmonics", "radii", fit.largest, 1e-6);
  ScratchFolder folder("scree_row17_gomboc");
  Library made;
  add_harmonic_shape(made, "gomboc", fit.coefficient);
  write_model(folder.path / "gomboc.h5", made);
  LibraryCase const library{"gomboc", folder.path / "gomboc.h5"};
  Vec3 const stable = transpose(made.shape[0].query.rotation) * Vec3{0, 0, -1};  // least radius, in the body's axes
  std::vector<Quat> start;
  for (Vec3 turn : {Vec3{2.8, 0, 0}, {0, 2, 0}, {-1.2, 0.5, 0.7}}) start.push_back(quat_from_rotation_vector(turn));
  if (full())
    for (Vec3 const n : quasi_uniform_directions(8)) start.push_back(quat_from_rotation_vector(n * 2.5));
  // Its last degrees are so flat that the nodes' spacing shows.
  std::vector<double> const tilt = tilts_at_the_end(grains_at("gomboc:*", {}, 0.1, full() ? 64000 : 16000), library,
                                                    stable, start, full() ? 30 : 18);
  for (std::size_t i = 0; i < tilt.size(); ++i)
    book.at_most(fmt::format("pose {}: tilt at the end", i + 1), "deg", tilt[i], full() ? 3 : 5);
  // The same poses, another body: with two stable equilibria it ends on both sides.
  std::vector<double> const other =
      tilts_at_the_end(grains_at("ellipsoid:1:0.97:0.94", {}, 0.1, 4000), library, {0, 0, -1}, start, 10);
  book.at_least("ellipsoid 1:0.97:0.94: largest tilt at the end", "deg", *std::max_element(other.begin(), other.end()),
                170);
  book.at_most("ellipsoid 1:0.97:0.94: least tilt at the end", "deg", *std::min_element(other.begin(), other.end()),
               10);
}

}  // namespace
}  // namespace scree::book
