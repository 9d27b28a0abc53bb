// scree_shape.cpp: the shape program: check and repair meshes, inspect model files.
// Links CGAL; distributed binaries are under GPL-3 because of it.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <system_error>

#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/mesh_measures.h"
#include "shapes/mesh/mesh_normalise.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "shapes/phi_batch.h"
#include "shapes/surface_nodes.h"
#include "shapes/zero_set.h"
#include "tools/guarded.h"

namespace {

using namespace scree;
namespace fs = std::filesystem;

struct ImportArguments {
  fs::path mesh, output;
  int largest_hole = 30;
  bool normalise = false, force = false;
};

struct InspectArguments {
  fs::path file;
  std::string shape;  // only this one; empty: all
  int nodes = 4000;
  int threads = 2;
};

// What reading finds wrong is the input's fault, whatever the reader calls it.
template <class Read>
auto read_input(Read const& read) {
  try {
    return read();
  } catch (std::runtime_error const& error) {
    throw std::invalid_argument(error.what());
  }
}

void check_output(fs::path const& file, bool force) {
  if (fs::is_directory(file)) throw std::invalid_argument(file.string() + " is a folder; name a file");
  if (fs::exists(file) && !force)
    throw std::invalid_argument(file.string() + " exists; choose another name or add --force");
  fs::path const folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw std::system_error(std::make_error_code(std::errc::no_such_file_or_directory), folder.string());
  if (::access(folder.c_str(), W_OK) != 0)
    throw std::system_error(errno, std::generic_category(), folder.string() + " cannot be written");
}

int import_mesh(ImportArguments const& a) {
  check_output(a.output, a.force);
  TriangleMesh const mesh = read_input([&] { return read_mesh(a.mesh); });
  MeshReport const before = check_mesh(mesh);
  fmt::print("{}: {} vertices, {} triangles, {} parts\n", a.mesh.string(), before.vertices, before.triangles,
             before.components);
  for (std::string const& defect : before.defects) fmt::print("  found: {}\n", defect);
  std::vector<std::string> actions;
  TriangleMesh clean = mesh;
  if (!before.defects.empty()) {
    try {
      clean = repair_mesh(mesh, &actions, a.largest_hole);
    } catch (std::runtime_error const& error) {
      throw std::invalid_argument(a.mesh.string() + ": " + error.what());
    }
  }
  for (std::string const& action : actions) fmt::print("  {}\n", action);
  Normalisation const n = normalisation_of(clean);
  MeshMass const mass = mesh_mass(clean);
  fmt::print("  volume {:.6g} unit^3, equal-volume diameter {:.6g} unit, centroid ({:.4g}, {:.4g}, {:.4g})\n",
             mass.volume, 1 / n.scale, n.centroid.x, n.centroid.y, n.centroid.z);
  fmt::print("  sphericity {:.3f}, convexity {:.3f}, longest to shortest extent {:.3f}\n", sphericity(clean),
             convexity(clean), aspect_ratio(clean));
  if (a.normalise) clean = transformed(clean, n);
  write_mesh(a.output, clean);
  fmt::print("{}: {} triangles, closed{}\n", a.output.string(), clean.triangle.size(),
             a.normalise ? ", normalised to d = 1" : "");
  return exit_ok;
}

// Measured now, from phi alone.
struct Measured {
  double gradient_p1 = 0, gradient_p99 = 0;  // of |grad phi| at points within 0.05 d of the surface
  double volume_error = 0;                   // of the normalised zero set against pi/6, relative
  int components = 0, euler_characteristic = 0;
  int nodes = 0;
  double gap = 0;          // [d]
  double closure = 0;      // |sum A n| / sum A
  double volume_gate = 0;  // |sum A x.n / (3 V) - 1|
};

Measured measure(Library const& library, Shape const& shape, InspectArguments const& a) {
  PhiBatch const phi = fast_phi(library, shape, a.threads);
  ZeroSetOptions options;
  options.radius = 1.1 * shape.bounding_radius;
  ZeroSet const set = find_zero_set(phi, options);
  Measured m;
  m.components = set.components;
  m.euler_characteristic = set.euler_characteristic;
  m.volume_error = zero_set_mass(phi, set).volume * 6 / std::numbers::pi - 1;

  std::vector<Vec3> point;
  for (std::size_t i = 0; i < set.mesh.vertex.size(); ++i)  // both sides by turns, at golden-ratio depths
    point.push_back(set.mesh.vertex[i] +
                    set.normal[i] * (0.1 * (std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0) - 0.5)));
  std::vector<double> value(point.size());
  std::vector<Vec3> gradient(point.size());
  phi(point, value, gradient);
  std::vector<double> slope;
  for (Vec3 const& g : gradient) slope.push_back(norm(g));
  std::sort(slope.begin(), slope.end());
  m.gradient_p1 = slope[slope.size() / 100];
  m.gradient_p99 = slope[slope.size() - 1 - slope.size() / 100];

  SurfaceNodes const nodes = make_surface_nodes(library, shape, a.nodes);
  m.nodes = nodes.n_surface;
  m.gap = nodes.largest_gap;
  Vec3 sum;
  double area = 0, moment = 0;
  for (int i = 0; i < nodes.n_surface; ++i) {
    sum += nodes.normal[i] * nodes.area[i];
    area += nodes.area[i];
    moment += nodes.area[i] * dot(nodes.position[i], nodes.normal[i]);
  }
  m.closure = norm(sum) / area;
  m.volume_gate = std::abs(moment / (3 * shape.volume) - 1);
  return m;
}

std::string figure(double value, char const* format = "{:.1e}") {
  return value < 0 ? std::string("-") : fmt::format(fmt::runtime(format), value);
}

int inspect(InspectArguments const& a) {
  Library const library = read_input([&] { return read_model(a.file); });
  std::vector<Shape const*> chosen;
  for (Shape const& shape : library.shape)
    if (a.shape.empty() || shape.name == a.shape) chosen.push_back(&shape);
  if (chosen.empty()) throw std::invalid_argument(a.file.string() + " has no shape '" + a.shape + "'");
  for (std::size_t k = 0; k < library.net.size(); ++k) {
    std::string width;
    for (int w : library.net[k].width) width += (width.empty() ? "" : "-") + std::to_string(w);
    fmt::print("network {}: {} {} ({:g})\n", k, width, to_string(library.net[k].activation), library.net[k].parameter);
  }
  fmt::print(
      "\ncertificate, units of d (-: not "
      "measured)\n{:<14}{:>9}{:>9}{:>9}{:>9}{:>7}{:>7}{:>8}{:>8}{:>9}{:>9}{:>9}{:>6}\n",
      "shape", "MAE", "p99", "max", "band", "n50", "n95", "|g|p1", "|g|p99", "volume", "inertia", "hausd.", "seed");
  for (Shape const* s : chosen) {
    Certificate const& c = s->certificate;
    fmt::print("{:<14}{:>9}{:>9}{:>9}{:>9}{:>7}{:>7}{:>8}{:>8}{:>9}{:>9}{:>9}{:>6}\n", s->name, figure(c.mae),
               figure(c.p99), figure(c.max), figure(c.band_mae), figure(c.normal_p50, "{:.2f}"),
               figure(c.normal_p95, "{:.2f}"), figure(c.gradient_p1, "{:.3f}"), figure(c.gradient_p99, "{:.3f}"),
               figure(c.volume_error), figure(c.inertia_error), figure(c.hausdorff),
               c.seed < 0 ? "-" : std::to_string(c.seed));
  }
  fmt::print(
      "\nmeasured now from phi (gates: parts 1, euler 2, volume and nodes 1e-3, gap 3e-3)\n"
      "{:<14}{:>8}{:>8}{:>7}{:>10}{:>6}{:>6}{:>8}{:>9}{:>10}{:>10}\n",
      "shape", "|g|p1", "|g|p99", "L", "volume", "parts", "euler", "nodes", "gap", "sum A n", "sum A x.n");
  for (Shape const* s : chosen) {
    Measured const m = measure(library, *s, a);
    fmt::print("{:<14}{:8.3f}{:8.3f}{:7.2f}{:10.1e}{:6d}{:6d}{:8d}{:9.1e}{:10.1e}{:10.1e}\n", s->name, m.gradient_p1,
               m.gradient_p99, s->lipschitz, m.volume_error, m.components, m.euler_characteristic, m.nodes, m.gap,
               m.closure, m.volume_gate);
    std::fflush(stdout);
  }
  fmt::print("\nmade with {}\n", chosen.front()->certificate.made_with);
  return exit_ok;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Check and repair meshes, inspect model files"};
  app.set_version_flag("--version",
                       "scree-shape " SCREE_VERSION
                       "\nScree is Apache-2.0; this program contains CGAL and is distributed under GPL-3.");
  app.require_subcommand(1);
  std::function<int()> chosen;

  ImportArguments import;
  CLI::App* const i = app.add_subcommand("import", "Check a mesh, repair simple defects, report its form");
  i->add_option("mesh", import.mesh, "Mesh (.stl, .obj), any unit")->required();
  i->add_option("-o,--output", import.output, "Mesh to write (.stl, .obj)")->required();
  i->add_option("--largest-hole", import.largest_hole, "Fill holes of at most this many edges")->capture_default_str();
  i->add_flag("--normalise", import.normalise,
              "Write it with volume pi/6, centroid at 0, principal axes along x, y, z");
  i->add_flag("--force", import.force, "Replace an existing output file");
  i->callback([&] { chosen = [&] { return import_mesh(import); }; });

  InspectArguments look;
  CLI::App* const c =
      app.add_subcommand("inspect", "Print certificates and measure gradients, volume, parts and nodes");
  c->add_option("file", look.file, "Model file (.h5)")->required();
  c->add_option("--shape", look.shape, "Only this shape");
  c->add_option("--nodes", look.nodes, "Surface nodes to measure")
      ->check(CLI::Range(4, 1000000))
      ->capture_default_str();
  c->add_option("--threads", look.threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c->callback([&] { chosen = [&] { return inspect(look); }; });

  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return app.exit(error) == 0 ? exit_ok : exit_bad_input;
  }
  return guarded("scree-shape", chosen);
}
