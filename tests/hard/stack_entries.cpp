// stack_entries.cpp: a stack of 20 blocks and an arch of wedges stand: no creep, no ringing that grows.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "shapes/mesh_files.h"
#include "shapes/mesh_normalise.h"
#include "tests/hard/course.h"
#include "tests/support/solids.h"

namespace scree::book {
namespace {

using namespace testing;

double constexpr gravity = 9.81, kappa = 2e6 / (M_PI * 0.025 * 1e-3);  // of rock_case [N/m3]

// Largest way of a grain between two frames [m].
double largest_way(Frame const& a, Frame const& b) {
  double way = 0;
  for (std::size_t i = 0; i < a.position.size(); ++i) way = std::max(way, norm(a.position[i] - b.position[i]));
  return way;
}

struct Standing {
  Course run;
  double time = 0;             // from the start, or with a settle stage from its last release, to the end [s]
  double creep = 0;            // way in the last half, per second [m/s]
  double early = 0, late = 0;  // largest kinetic energy of a grain in the third and the last quarter [m g d]
};

// Follows `s` until it has stood for `time` seconds; with a settle stage they count from the release of its damping.
Standing stand(Simulation& s, double time) {
  Standing out;
  Frame half;
  double since = 0;
  out.run = follow(s, [&] {
    if (s.phase() == "settling") since = s.time(), half = {}, out.early = out.late = 0;
    double const t = (s.time() - since) / time;
    if (t > 0.5 && half.position.empty()) half = s.frame();
    if (t > 0.5 && t < 0.75) out.early = std::max(out.early, s.largest_kinetic_per_grain());
    if (t > 0.75) out.late = std::max(out.late, s.largest_kinetic_per_grain());
  });
  out.time = s.time() - since;
  if (!half.position.empty()) out.creep = largest_way(half, s.frame()) / (s.time() - half.time);
  return out;
}

TEST(Hard, StackOfTwentyBlocks) {
  Entry book("hard", "stack", "20 blocks stand on each other", "Winkler face: overlap i = (n - i) m g / (kappa A)");
  int const n = 20;
  double const d = 0.1, side = d * std::cbrt(M_PI / 6), weight = 2650 * side * side * side * gravity;
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.contact[0].damping_ratio = 0.7;
  c.contact[0].friction = 0.5;
  int const nodes = full() ? 1000 : 200;
  GrainsCase g = grains_at("box:1:1:1", {}, d, nodes);
  // A node on an edge of a cube has 0.71 of its cell's area, and carries that on either face where 0.5 lies: with nodes
  // h apart a face of side s is 0.83 h / s too stiff.
  double const edges = 0.83 * std::sqrt(6.0 / nodes);
  double z = 0;
  for (int i = 0; i < n; ++i) {
    z -= (n - i) * weight / (kappa * side * side * (1 + edges));
    g.insert.position.push_back({0, 0, z + side / 2});
    z += side;
  }
  g.count = n;
  c.grains = {g};
  c.wall = {floor_at(0)};
  // The slowest bending of the column, 4.4 Hz, takes 30 s to ring down by contact damping alone (zeta of a mode is that
  // of a contact times the ratio of their frequencies, 1e-3): it is taken out before the 10 s begin.
  double const standing = full() ? 10 : 0.05;
  c.time.end = full() ? 30 : standing;
  if (full()) c.time.settle = SettleCase{5, 0, 1e-13, standing};
  Simulation s(c, {});
  Standing const r = stand(s, standing);
  EXPECT_EQ(r.run.stopped, "");
  if (full()) book.relative("time of standing", "s", standing, r.time, 1e-3);
  double bottom = 0;
  for (std::size_t k = 0; k < s.impl().work.pair.size(); ++k)
    if (s.impl().work.pair[k].with_plane()) bottom = s.impl().work.result[k].overlap;
  book.relative("overlap of the lowest block", "m", n * weight / (kappa * side * side), bottom, edges + 0.02);
  book.at_most("creep", "d/s", r.creep / d, full() ? 1e-6 : 2e-2);  // short runs still ring
  book.at_most("kinetic energy, last quarter over the third", "", r.late / std::max(r.early, 1e-20), 1);
  book.at_most("kinetic energy at the end", "m g d", r.run.kinetic, full() ? 1e-12 : 1e-5);
  double aside = 0;
  for (Vec3 const& x : s.frame().position) aside = std::max(aside, std::hypot(x.x, x.y));
  book.at_most("furthest aside", "d", aside / d, 1e-3);
}

// Voussoirs of a half circle between the radii 0.8 and 1 m, 0.3 m deep: with this thickness it stands under its own
// weight (the thinnest half circle that does has t/R = 0.1075, Heyman 1969; here 0.222).
TEST(Hard, ArchOfWedges) {
  Entry book("hard", "arch", "half-circle arch of nine wedges", "Heyman (1969): stands if thickness/radius > 0.1075");
  std::filesystem::path const file =
      std::filesystem::temp_directory_path() / ("scree_wedge_" + std::to_string(::getpid()) + ".stl");
  int const n = 9;
  double const angle = M_PI / n;
  auto const at = [](double r, double a, double y) { return Vec3{r * std::cos(a), y, r * std::sin(a)}; };
  std::array<Vec3, 8> corner;
  for (int k = 0; k < 8; ++k) corner[k] = at(k & 1 ? 1 : 0.8, k & 4 ? angle : 0, k & 2 ? 0.15 : -0.15);
  TriangleMesh wedge = hexahedron(corner);
  if (mesh_mass(wedge).volume < 0)
    for (auto& t : wedge.triangle) std::swap(t[1], t[2]);
  write_mesh(file, wedge);
  Normalisation const to = normalisation_of(read_mesh(file));
  double const d = 1 / to.scale;
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -gravity};
  c.contact[0].kappa = 1e10;
  c.contact[0].damping_ratio = 0.7;
  c.contact[0].friction = 0.7;
  GrainsCase g = grains_at("mesh:" + file.string(), {}, d, full() ? 400 : 150);
  Quat const own = rotation_quat(transpose(to.rotation));
  for (int i = 0; i < n; ++i) {
    Quat const turn = quat_from_rotation_vector({0, -i * angle, 0});
    g.insert.position.push_back(to_matrix(turn) * to.centroid);
    g.insert.quaternion.push_back(turn * own);
  }
  g.count = n;
  c.grains = {g};
  c.wall = {floor_at(0)};
  c.time.end = full() ? 10 : 0.03;
  Simulation s(c, {});
  Frame const start = s.frame();
  Standing const r = stand(s, c.time.end);
  EXPECT_EQ(r.run.stopped, "");
  book.at_most("worst overlap", "d", r.run.overlap, 0.01);
  book.at_most("furthest any wedge moved", "d", largest_way(start, s.frame()) / d, 0.01);
  book.at_most("creep", "d/s", r.creep / d, full() ? 1e-6 : 2e-2);  // short runs still take up the load
  book.at_most("kinetic energy, last quarter over the third", "", r.late / std::max(r.early, 1e-20), 1);
  book.at_most("kinetic energy at the end", "m g d", r.run.kinetic, full() ? 1e-12 : 1e-5);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace scree::book
