// rattleback_entries.cpp: row 17 of the book: a rattleback spun the wrong way turns round, the other way it does not.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/simulation_impl.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_normalise.h"
#include "tests/support/cases.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids.h"
#include "tests/validation/book.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr gravity = 9.81, length = 0.1, width = 0.04, depth = 0.03;  // of the half ellipsoid [m]

// Half an ellipsoid below z = 0; above it two low heaps, to the left of the long axis at one end and to the right of it
// at the other. So the axes of inertia are turned against those of the surface that it rolls on, here by 8 degrees.
// skew: 1, its mirror image -1, or 0 without.
TriangleMesh rattleback(double skew) {
  int const rings = 60, around = 120;
  double const heap = 0.04;  // [m]
  TriangleMesh m;
  for (int half = 0; half < 2; ++half)  // below, then above
    for (int k = half; k < rings; ++k)  // from the rim to the pole; the rim belongs to both
      for (int i = 0; i < around; ++i) {
        double const r = std::cos(M_PI / 2 * k / rings), angle = 2 * M_PI * i / around;
        double const x = r * std::cos(angle), y = r * std::sin(angle);
        double const z = half == 0 ? -depth * std::sqrt(1 - r * r)
                                   : heap * 4 * r * r * (1 - r * r) * (1 + skew * std::sin(2 * angle));
        m.vertex.push_back({length * x, width * y, z});
      }
  auto const at = [&](int half, int k, int i) {
    return half == 0 || k == 0 ? k * around + i % around : (rings + k - 1) * around + i % around;
  };
  for (int half = 0; half < 2; ++half) {
    int const pole = static_cast<int>(m.vertex.size());
    m.vertex.push_back({0, 0, half == 0 ? -depth : 0});
    for (int i = 0; i < around; ++i) {
      for (int k = 0; k + 1 < rings; ++k) {
        m.triangle.push_back({at(half, k, i), at(half, k, i + 1), at(half, k + 1, i + 1)});
        m.triangle.push_back({at(half, k, i), at(half, k + 1, i + 1), at(half, k + 1, i)});
      }
      m.triangle.push_back({at(half, rings - 1, i), at(half, rings - 1, i + 1), pole});
    }
    if (half == 0)
      for (auto& t : m.triangle) std::swap(t[1], t[2]);
  }
  return m;
}

struct Spun {
  double skew = 0;                        // of the axes of inertia against those of the ellipsoid [deg]
  std::vector<std::vector<double>> spin;  // of each body, its mean in every second [rad/s]
  double residual = 0;                    // of the ledger, of the energy moved
};

// Bodies on a plane, each with one of the spins [rad/s] and by itself, let go pitched by 0.15 rad, so that rocking does
// not have to grow from rounding.
Spun spin_them(double skew, std::vector<double> const& spins, int seconds) {
  ScratchFolder folder("scree_row17_rattleback");
  write_mesh(folder.path / "body.ply", rattleback(skew));
  Normalisation const frame = normalisation_of(read_mesh(folder.path / "body.ply"));
  double const d = 1 / frame.scale;
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  // The patch of contact takes spin by friction, in proportion to its radius: it has to be small, 1e-2 of the length.
  // It still holds some nodes. Weight = pi sqrt(R1 R2) kappa sink^2 with the radii of curvature below, R1 R2 = (a b /
  // c)^2.
  double const sink = 1e-5;  // [m]
  c.contact[0].kappa = 2650 * M_PI / 6 * d * d * d * gravity / (M_PI * length * width / depth * sink * sink);
  c.contact[0].damping_ratio = 0.01;
  c.contact[0].friction = 0.3;
  double const pitch = 0.15, height = std::hypot(depth * std::cos(pitch), length * std::sin(pitch)) - sink;
  Quat const pitched = quat_from_rotation_vector({0, pitch, 0});
  for (std::size_t i = 0; i < spins.size(); ++i) {
    Vec3 const at = to_matrix(pitched) * frame.centroid + Vec3{0, 10 * length * i, height};
    GrainsCase g = grains_at("mesh:" + (folder.path / "body.ply").string(), {at}, d, full() ? 64000 : 16000);
    g.name = "body" + std::to_string(i);
    g.insert.quaternion = {pitched * rotation_quat(transpose(frame.rotation))};
    g.insert.spin = {0, 0, spins[i]};
    c.grains.push_back(g);
  }
  c.wall = {floor_at(0)};
  c.time.safety = 0.6;  // the ledger still closes to 1e-5
  c.time.end = seconds + 0.01;
  Simulation s(c, {});
  Spun out;
  out.spin.resize(spins.size(), std::vector<double>(seconds));
  std::vector<int> count(seconds);
  while (s.step() == RunState::running) {
    int const second = static_cast<int>(s.time());
    if (second == seconds) continue;
    ++count[second];
    Frame const f = s.frame();
    for (std::size_t i = 0; i < spins.size(); ++i) out.spin[i][second] += f.spin[i].z;
  }
  for (std::vector<double>& body : out.spin)
    for (int k = 0; k < seconds; ++k) body[k] /= count[k];
  Vec3 const along = transpose(frame.rotation) * Vec3{1, 0, 0};
  out.skew = 180 / M_PI * std::atan(along.y / along.x);
  out.residual = std::abs(s.ledger().residual) / s.ledger().moved;
  return out;
}

// Signs are those of the theory (Bondi, Proc. R. Soc. A 405 (1986) 265: with skewed axes one sense of spin is unstable
// against pitching). Friction takes spin and never turns it round, so that without a reversal only the sign is judged;
// with one, half of the first second's spin has to come back.
TEST(Validation, Row17Rattleback) {
  Entry book("validation", "17b", "a rattleback turns round when it is spun the wrong way, and only then",
             "Bondi (1986) for the signs");
  int const seconds = full() ? 5 : 3;
  auto const judge = [&](std::string const& what, std::vector<double> const& spin, bool turns_round) {
    for (int k = 0; k < seconds; ++k)
      book.point("spin [rad/s] against time [s], " + what, k + 0.5, std::nan(""), spin[k]);
    double least = 1;  // over the first second's
    for (double w : spin) least = std::min(least, w / spin[0]);
    if (turns_round)
      book.at_most(what + ": spin in the last second over the first", "", spin.back() / spin[0], -0.5);
    else
      book.at_least(what + ": least spin of any second over the first", "", least, 0);
  };
  Spun const body = spin_them(1, {-4, 4}, seconds);
  book.absolute("skew of the axes of inertia", "deg", 8.3, body.skew, 0.1);
  judge("the wrong way", body.spin[0], true);
  judge("the right way", body.spin[1], false);
  book.at_most("ledger residual of the energy moved", "", body.residual, 1e-3);
  Spun const straight = spin_them(0, {-4}, seconds);
  judge("a body without skew", straight.spin[0], false);
  if (!full()) return;
  Spun const image = spin_them(-1, {-4, 4}, seconds);
  judge("the mirror image, its right way", image.spin[0], false);
  judge("the mirror image, its wrong way", image.spin[1], true);
}

}  // namespace
}  // namespace scree::book
