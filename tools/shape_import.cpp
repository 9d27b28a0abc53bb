// shape_import.cpp: `scree-shape import`: check a mesh, repair what is simple, report its form; networks of other
// programs into a model file.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/mesh_measures.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_normalise.h"
#include "tools/guarded.h"
#include "tools/network_import.h"
#include "tools/shape_commands.h"
#include "tools/shape_input.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct ImportArguments {
  fs::path mesh, output;
  int largest_hole = 30;
  bool normalise = false, force = false;
  NetworkImport network;
};

int import_mesh(ImportArguments const& a) {
  if (a.network.any_convention())
    throw std::invalid_argument(a.mesh.string() +
                                ": --activation, --parameter, --name, --radius and --negative-inside are for networks "
                                "(.safetensors)");
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

int import_file(ImportArguments const& a) {
  if (!is_network_file(a.mesh)) return import_mesh(a);
  NetworkImport network = a.network;
  network.file = a.mesh, network.output = a.output, network.force = a.force;
  return import_networks(network);
}

}  // namespace

void add_import(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<ImportArguments>();
  CLI::App* const c = app.add_subcommand("import", "Check a mesh, repair simple defects, report its form; or networks");
  c->add_option("mesh", a->mesh, "Mesh (.stl, .obj, .ply), any unit; or networks (.safetensors)")->required();
  c->add_option("-o,--output", a->output, "Mesh (.stl, .obj, .ply) or, for networks, model file (.h5) to write")
      ->required();
  c->add_option("--largest-hole", a->largest_hole, "Fill holes of at most this many edges")->capture_default_str();
  c->add_flag("--normalise", a->normalise, "Write it with volume pi/6, centroid at 0, principal axes along x, y, z");
  c->add_flag("--force", a->force, "Replace an existing output file");
  NetworkImport& n = a->network;
  c->add_option("--activation", n.activation, "Of another program's network")
      ->check(CLI::IsMember({"leaky_relu", "sine", "softplus"}));
  c->add_option("--parameter", n.parameter, "Its slope, omega or beta")->check(CLI::NonNegativeNumber);
  c->add_option("--name", n.name, "Name of its shape (default: the file's)");
  c->add_option("--radius", n.radius, "Ball about the origin that holds its surface, in its unit (default: 1.5)")
      ->check(CLI::PositiveNumber);
  c->add_flag("--negative-inside", n.negative_inside, "Its phi is negative inside");
  c->callback([a, &chosen] { chosen = [a] { return import_file(*a); }; });
}

}  // namespace scree
