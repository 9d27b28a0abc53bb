// collision_entries.cpp: row 8 of the book: frictionless, undamped collisions keep momenta and kinetic energy, whatever
// answers for phi and whatever its slope.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "shapes/certify_phi.h"
#include "shapes/model_file.h"
#include "shapes/normalise.h"
#include "tests/support/cases.h"
#include "tests/support/shape_kinds.h"
#include "tests/validation/entries.h"

namespace scree::book {

using namespace testing;
namespace fs = std::filesystem;

namespace {

struct Collision {
  double momentum = 0, angular_momentum = 0, kinetic = 0;  // relative changes
  double overlap = 0;                                      // peak [d]
  bool parted = false;                                     // the run was long enough
};

Case collision_case(Encounter const& setup) {
  std::mt19937 random(setup.seed);
  std::uniform_real_distribution<double> u(-1, 1);
  Case c = rock_case();
  c.library = setup.library;
  GrainsCase a = grains_at(setup.shape_a, {{-0.1, 0.01 * u(random), 0.01 * u(random)}});
  GrainsCase b = grains_at(setup.shape_b, {{0.1, 0, 0}});
  for (GrainsCase* g : {&a, &b}) {
    g->insert.quaternion = {normalized(Quat{u(random), u(random), u(random), u(random)})};
    g->evaluator = setup.evaluator;
    g->grid_cells = 32, g->mesh_cells = 8;  // coarse: energy does not wait for accuracy
  }
  b.name = "other";
  a.storage = setup.storage_a, b.storage = setup.storage_b;
  a.insert.velocity = {setup.speed, 0, 0};
  b.insert.velocity = {-setup.speed, 0.1 * setup.speed, 0};
  c.grains = {a, b};
  c.time.end = 0.25 / setup.speed;
  c.time.safety = setup.safety;
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

Collision collide(Encounter const& setup, Flaw const& flaw) {
  Simulation s(collision_case(setup), {});
  flaw.start(s);
  Simulation::Impl& impl = s.impl();
  Vec3 p0, l0, p1, l1;
  total_momenta(impl, p0, l0);
  double const k0 = impl.report.kinetic_total;
  Collision out;
  while (flaw.step(s) == RunState::running) {
    out.overlap = std::max(out.overlap, s.largest_overlap());
    if (out.overlap > 0 && s.largest_overlap() == 0 && norm(impl.state.position[0] - impl.state.position[1]) > 0.16)
      break;
  }
  total_momenta(impl, p1, l1);
  double const scale = impl.scene.mass[0] * setup.speed;
  out.parted = s.largest_overlap() == 0;
  out.momentum = norm(p1 - p0) / scale;
  out.angular_momentum = norm(l1 - l0) / (scale * 0.1);
  out.kinetic = std::abs(impl.report.kinetic_total / k0 - 1);
  return out;
}

}  // namespace

void frictionless_collisions(Entry& book, std::string const& name, std::vector<Encounter> const& encounters,
                             double kinetic, Flaw const& flaw) {
  Collision worst;
  double shallowest = 1;
  int parted = 0;
  for (Encounter const& e : encounters) {
    Collision const r = collide(e, flaw);
    worst.momentum = std::max(worst.momentum, r.momentum);
    worst.angular_momentum = std::max(worst.angular_momentum, r.angular_momentum);
    worst.kinetic = std::max(worst.kinetic, r.kinetic);
    shallowest = std::min(shallowest, r.overlap);
    parted += r.parted;
    if (encounters.size() > 1)
      book.point("change of the kinetic energy [-] against peak overlap [d], " + name, r.overlap, std::nan(""),
                 r.kinetic);
  }
  int const n = static_cast<int>(encounters.size());
  std::string const of = fmt::format("{}, {} pose{}: ", name, n, n == 1 ? "" : "s");
  book.at_most(of + "change of linear momentum", "", worst.momentum, 1e-10);
  book.at_most(of + "change of angular momentum", "", worst.angular_momentum, 1e-10);
  book.at_most(of + "change of kinetic energy", "", worst.kinetic, kinetic);
  book.at_least(of + "least peak overlap", "d", shallowest, 1e-3);
  book.absolute(of + "encounters still in contact at the end", "", 0, n - parted, 0);
}

// phi(x) = c - sum_i a_i softplus(n_i . x - h), normalised and certified.
LibraryCase warped_library() {
  static LibraryCase const library = [] {
    int const width = 24;
    Mlp net;
    net.activation = Activation::softplus;
    net.parameter = 12;
    net.width = {3, width, 1};
    net.weight = {std::vector<float>(3 * width), std::vector<float>(width)};
    net.bias = {std::vector<float>(width, -0.15f), {0.55f}};
    for (int i = 0; i < width; ++i) {
      double const z = 1 - 2 * (i + 0.5) / width, r = std::sqrt(1 - z * z), angle = 2.399963 * i;
      double const n[3] = {r * std::cos(angle), r * std::sin(angle), z};
      for (int k = 0; k < 3; ++k) net.weight[0][k * width + i] = static_cast<float>(n[k]);
      net.weight[1][i] = static_cast<float>(-0.25 - 0.2 * n[0] - 0.1 * n[2]);
    }
    Library made;
    made.net = {net};
    Shape shape;
    shape.name = "warped";
    shape.kind = ShapeKind::net;
    shape.net = 0;
    made.shape = {shape};
    normalise_net(made, 0, 2.0);
    certify_phi(made, made.shape[0], {2000, 1000, 1}, made.shape[0].certificate);  // the gate wants it
    fs::path const file = fs::temp_directory_path() / fmt::format("scree_book_warped_{}.h5", ::getpid());
    write_model(file, made, true);
    return LibraryCase{"warped", file};
  }();
  static struct Remove {
    ~Remove() { fs::remove(library.file); }
  } const at_exit;
  return library;
}

namespace {

double constexpr smooth = 1e-4, kinked = 3e-4;  // of the kinetic energy: smooth phi; LeakyReLU, cells, facets

LibraryCase shipped() { return {"grains", fs::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5"}; }

std::vector<Encounter> poses(Encounter e, int count) {
  std::vector<Encounter> out(count, e);
  for (int i = 0; i < count; ++i) out[i].seed = i;
  return out;
}

TEST(Validation, Row8FrictionlessCollisionsOfFormulas) {
  Entry book("validation", "8", "frictionless collisions of formulas keep momenta and energy", "closed form");
  int const count = full() ? 100 : 4;
  for (char const* shape : {"ellipsoid:1:0.8:0.6", "ellipsoid:1:0.5:0.5", "superellipsoid:1:0.8:0.7:0.6"})
    frictionless_collisions(book, shape, poses({shape, shape}, count), smooth);
}

TEST(Validation, Row8FrictionlessCollisionsOfShippedNetworks) {
  Entry book("validation", "8", "frictionless collisions of the shipped grains keep momenta and energy", "closed form");
  Library const library = read_model(shipped().file);
  int const shapes = static_cast<int>(library.shape.size());
  std::vector<Encounter> arrays, compact;
  auto const word = [&](int i) { return "grains:" + library.shape[i % shapes].name; };
  for (int pose = 0; pose < (full() ? 200 : 20); ++pose)
    arrays.push_back({word(pose), word(7 * pose + 3), {shipped()}, unsigned(pose), 2});
  frictionless_collisions(book, "networks, both 2 m/s", arrays, kinked);
  // Nodes kept as 16-bit radii, against their like and against arrays: nothing is lost to their rounding.
  char const* const some[4] = {"grains:ballast/0", "grains:sand/1", "grains:ellipsoid/4", "grains:ballast/3"};
  for (int pose = 0; pose < 4; ++pose)
    compact.push_back({.shape_a = some[pose],
                       .shape_b = some[(pose + 1) % 4],
                       .library = {shipped()},
                       .seed = unsigned(pose),
                       .speed = 2,
                       .storage_a = NodeStorage::compact,
                       .storage_b = pose == 1 ? NodeStorage::explicit_ : NodeStorage::compact});
  frictionless_collisions(book, "networks with compact nodes", compact, kinked);
}

// The exact gradient conserves for any slope; sabotage_test.cpp shows that a normalised one does not.
TEST(Validation, Row8FrictionlessCollisionsOfAWarpedPhi) {
  Entry book("validation", "8", "frictionless collisions on a phi whose slope is not 1", "closed form");
  LibraryCase const warped = warped_library();
  Library const library = read_model(warped.file);
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
  book.at_least("largest over least |grad phi| near the surface: phi is warped", "", high / low, 1.5);
  frictionless_collisions(book, "warped networks", poses({"warped:warped", "warped:warped", {warped}, 0, 2}, 5),
                          kinked);
}

// The same bodies as networks, grids, meshes and formulas.
TEST(Validation, Row8FrictionlessCollisionsUnderEveryEvaluator) {
  Entry book("validation", "8", "frictionless collisions of the same body under every evaluator", "closed form");
  fs::path const folder = fs::temp_directory_path() / fmt::format("scree_book_kinds_{}", ::getpid());
  fs::create_directories(folder);
  auto const stored = [&](char const* kind) {
    fs::path const file = folder / (std::string(kind) + ".h5");
    if (!fs::exists(file)) write_model(file, library_of_kind(kind));
    return std::vector<LibraryCase>{{std::string("stored_") + kind, file}};
  };
  auto const collide_as = [&](std::string const& name, std::string const& shape,
                              std::vector<LibraryCase> const& library, std::vector<Evaluator> const& evaluators,
                              double kinetic, double safety) {
    for (Evaluator evaluator : evaluators)
      frictionless_collisions(book, name + ", " + evaluator_name(evaluator),
                              poses({shape, shape, library, 0, 1, safety, evaluator}, full() ? 20 : 1), kinetic);
  };
  using enum Evaluator;
  collide_as("ellipsoid 1:0.8:0.6", "ellipsoid:1:0.8:0.6", {}, {analytic, grid, mesh}, kinked, 0.3);
  collide_as("shipped ellipsoid/0", "grains:ellipsoid/0", {shipped()}, {net, grid, mesh}, kinked, 0.3);
  collide_as("network with a code", "stored_coded_net:*", stored("coded_net"), {net, grid, mesh}, kinked, 0.3);
  collide_as("lobed harmonics", "stored_harmonics:*", stored("harmonics"), {analytic, grid, mesh}, kinked, 0.3);
  collide_as("stored grid", "stored_grid:*", stored("grid"), {net}, kinked, 0.3);
  // Flat faces and edges let many nodes in within one step, and the error falls with the step: 3.5e-3 at the automatic
  // one, 1.0e-3 at a sixth of it.
  collide_as("box 1:0.8:0.6", "box:1:0.8:0.6", {}, {analytic, mesh}, 1e-3, 0.03);
  collide_as("stored mesh, L-prism", "stored_mesh:*", stored("mesh"), {net}, 1e-3, 0.01);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace scree::book
