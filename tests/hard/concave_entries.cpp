// concave_entries.cpp: grains that hold each other by their holes and bends stay so, and come to rest without jitter.
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

class Folder {
 public:
  Folder() : at(std::filesystem::temp_directory_path() / ("scree_concave_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(at);
  }
  ~Folder() { std::filesystem::remove_all(at); }
  std::filesystem::path const at;
};

// Rod through the origin along y, thin enough to hang things on.
WallCase rod(double radius) {
  WallCase w;
  w.name = "rod";
  w.material = "rock";
  w.kind = WallKind::capsule;
  w.from = {0, -0.1, 0}, w.to = {0, 0.1, 0};
  w.radius = radius;
  return w;
}

// Bodies of one mesh, each given by the rotation and the shift of the mesh as it was drawn [m].
GrainsCase placed(std::filesystem::path const& file, std::vector<Quat> const& turn, std::vector<Vec3> const& shift,
                  int nodes) {
  Normalisation const to = normalisation_of(read_mesh(file));
  GrainsCase g = grains_at("mesh:" + file.string(), {}, 1 / to.scale, nodes);
  Quat const own = rotation_quat(transpose(to.rotation));
  for (std::size_t i = 0; i < turn.size(); ++i) {
    g.insert.position.push_back(shift[i] + to_matrix(turn[i]) * to.centroid);
    g.insert.quaternion.push_back(turn[i] * own);
  }
  g.count = static_cast<int>(turn.size());
  return g;
}

Case hanging(GrainsCase const& g, double rod_radius) {
  Case c = rock_case();
  c.gravity = Vec3{0, 0, -9.81};
  c.contact[0].kappa = 2e10;
  c.contact[0].damping_ratio = 0.7;
  c.contact[0].friction = 0.5;
  c.grains = {g};
  c.wall = {rod(rod_radius)};
  c.time.settle = SettleCase{30, 0, 1e-8, 0.02};
  c.time.end = full() ? 20 : 2;
  return c;
}

void expect_to_hang(Entry& book, std::string const& name, Case const& c, double lowest) {
  Simulation s(c, {});
  EXPECT_LT(s.largest_overlap(), 1e-3) << "they start inside each other";
  Course const run = follow(s);
  add_sound_rows(book, name, run, 1e-3, 2e-3);
  EXPECT_EQ(s.state(), RunState::at_rest) << name;
  book.at_most(name + ": kinetic energy at rest, nothing damping it", "m g d", run.kinetic, 1e-8);
  book.at_most(name + ": worst overlap", "d", run.overlap, c.limits.overlap);
  double z = 0;
  for (Vec3 const& x : s.frame().position) z = std::min(z, x.z);
  book.at_least(name + ": lowest centre", "m", z, lowest);
  book.trend(name + ": at rest after", "s", s.time());
}

TEST(Hard, ChainOfRingsHangs) {
  Entry book("hard", "rings", "chain of tori on a rod stays interlocked", "lowest place that the rings' size allows");
  Folder const folder;
  double const big = 0.03, small = 0.006, pole = 0.006;  // radii [m]
  auto const circle = [&](double u) { return Vec3{big * std::cos(2 * M_PI * u), 0, big * std::sin(2 * M_PI * u)}; };
  write_mesh(folder.at / "ring.stl", tube(circle, small, 48, 16, true));
  int const links = full() ? 4 : 2;
  std::vector<Quat> turn;
  std::vector<Vec3> shift;
  double z = pole - (big - small) + 2e-4;  // the first ring's inner side lies on the rod, all but a gap
  for (int i = 0; i < links; ++i) {
    // Alternately in the planes y = 0 and x = 0.
    turn.push_back(i % 2 ? quat_from_rotation_vector({0, 0, M_PI / 2}) : Quat{});
    shift.push_back({0, 0, z});
    z -= 2 * (big - small) - 2e-4;
  }
  expect_to_hang(book, "rings", hanging(placed(folder.at / "ring.stl", turn, shift, 1500), pole),
                 pole - (big - small) - (links - 1) * 2 * (big - small) - 2e-3);
}

TEST(Hard, HooksHang) {
  Entry book("hard", "hooks", "a hook on a rod, a second hook in the first",
             "lowest place that the hooks' size allows");
  Folder const folder;
  double const bend = 0.02, wire = 0.005, shank = 0.03, pole = 0.008;  // [m]
  // S: half circles at both ends of a straight shank, open to opposite sides; drawn in the plane y = 0.
  auto const s_line = [&](double u) {
    double const arc = M_PI * bend, whole = 2 * arc + shank;
    double const way = u * whole;
    if (way < arc) {
      double const a = way / bend;  // from the free tip over the top to the shank
      return Vec3{-bend + bend * -std::cos(a), 0, shank / 2 + bend * std::sin(a)};
    }
    if (way < arc + shank) return Vec3{0, 0, shank / 2 - (way - arc)};
    double const a = (way - arc - shank) / bend;
    return Vec3{bend - bend * std::cos(a), 0, -shank / 2 - bend * std::sin(a)};
  };
  write_mesh(folder.at / "hook.stl", tube(s_line, wire, 60, 16, false));
  // Hanging, the centres of both half circles stand above one another; half their distance:
  double const half = std::hypot(bend, shank / 2), inner = bend - wire, gap = 2e-4;
  Quat const upright = quat_from_rotation_vector({0, std::atan2(bend, shank / 2), 0});
  double const first = pole + gap - inner - half;               // centre of the first [m]
  double const second = first - half - 2 * inner + gap - half;  // its crown lies in the lower bend of the first
  std::vector<Quat> const turn{upright, quat_from_rotation_vector({0, 0, M_PI / 2}) * upright};
  std::vector<Vec3> const shift{{0, 0, first}, {0, 0, second}};
  expect_to_hang(book, "hooks", hanging(placed(folder.at / "hook.stl", turn, shift, 1500), pole), second - 2e-3);
}

}  // namespace
}  // namespace scree::book
