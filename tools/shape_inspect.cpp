// shape_inspect.cpp: `scree-shape inspect`: print certificates, and measure them from phi.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/certify_phi.h"
#include "shapes/mesh/certify_mesh.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "shapes/text_lines.h"
#include "tools/certificate_plot.h"
#include "tools/certificate_table.h"
#include "tools/guarded.h"
#include "tools/shape_commands.h"
#include "tools/shape_input.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct InspectArguments {
  fs::path file;
  fs::path mesh, plot;  // empty: none
  std::string shape;    // only this one; empty: all
  bool write = false, force = false;
  CertifyPhiOptions options{.threads = 2};
};

void print_networks(Library const& library) {
  for (std::size_t k = 0; k < library.net.size(); ++k) {
    std::string width;
    for (int w : library.net[k].width) width += (width.empty() ? "" : "-") + std::to_string(w);
    fmt::print("network {}: {} {} ({:g})\n", k, width, to_string(library.net[k].activation), library.net[k].parameter);
  }
}

std::vector<Shape*> chosen_shapes(Library& library, InspectArguments const& a) {
  std::vector<Shape*> chosen;
  for (Shape& shape : library.shape)
    if (a.shape.empty() || shape.name == a.shape) chosen.push_back(&shape);
  if (chosen.empty()) throw std::invalid_argument(a.file.string() + " has no shape '" + a.shape + "'");
  return chosen;
}

std::vector<Shape> copies(std::vector<Shape*> const& shapes) {
  std::vector<Shape> out;
  for (Shape const* s : shapes) out.push_back(*s);
  return out;
}

// One mesh and one picture are of one shape.
void check_arguments(InspectArguments const& a, std::vector<Shape*> const& chosen) {
  if ((!a.mesh.empty() || !a.plot.empty()) && chosen.size() != 1) {
    std::string names;
    for (Shape const* s : chosen) names += (names.empty() ? "" : ", ") + s->name;
    throw std::invalid_argument(
        a.file.string() + " has several shapes; --mesh and --plot take one: choose with --shape one of: " + names);
  }
  if (a.plot.empty()) return;
  std::string const extension = lower_extension(a.plot);
  if (extension != ".png" && extension != ".svg")
    throw std::invalid_argument(a.plot.string() + ": write a .png or .svg picture");
  for (fs::path const& file : plot_files(a.plot)) check_output(file, a.force);
}

double constexpr foreign_rms = 0.02;  // above this the mesh is hardly what the shape was made from [d]

// Lays the mesh onto the shape and fills in what is measured against it.
std::unique_ptr<MeshTruth> measure_against(InspectArguments const& a, Library const& library, Shape& shape) {
  if (a.mesh.empty()) return {};
  TriangleMesh mesh = read_input([&] { return read_mesh(a.mesh); });
  std::unique_ptr<MeshTruth> truth;
  try {
    truth = std::make_unique<MeshTruth>(std::move(mesh), library, shape, a.options.threads);
  } catch (std::invalid_argument const& error) {
    throw std::invalid_argument(a.mesh.string() + ": " + error.what());
  }
  double const rms = truth->alignment().rms;
  fmt::print("\n{} laid onto {} by rotation, shift and scale: phi on it {:.1e} d (rms), d = {:.6g} of its unit\n",
             a.mesh.string(), shape.name, rms, truth->alignment().frame.scale);
  if (rms > foreign_rms) fmt::print("warning: that is far off; is it the mesh that {} was made from?\n", shape.name);
  truth->certify(fast_phi(library, shape, a.options.threads), shape, a.options.points, 1, shape.certificate);
  return truth;
}

// The yardstick of certificates is the mesh as it is. A scan's triangles turn to and fro about the surface that they
// sample: how much of the error is that.
void print_normals(NormalComparison const& normals) {
  auto const line = [](char const* what, NormalAngles const& angle) {
    fmt::print("{:44}{:>8.2f}{:>7.2f}{:>10.2f}\n", what, angle.p50, angle.p95, angle.flat_p95);
  };
  fmt::print("\n{:44}{:>8}{:>7}{:>10}\n", "normals at the mesh [degrees]", "p50", "p95", "flat p95");
  line("phi to the triangles", normals.to_triangles);
  line("phi to normals interpolated over the mesh", normals.to_interpolated);
  line("the triangles to the interpolated normals", normals.triangles_to_interpolated);
}

int inspect(InspectArguments const& a) {
  Library library = read_input([&] { return read_model(a.file); });
  std::vector<Shape*> const chosen = chosen_shapes(library, a);
  check_arguments(a, chosen);
  print_networks(library);
  fmt::print("\ncertificate (-: not measured; normals in degrees)\n{}\n{}", error_table(copies(chosen)),
             phi_table(copies(chosen)));
  std::set<std::string> makers;
  for (Shape const* s : chosen)
    if (!s->certificate.made_with.empty()) makers.insert(s->certificate.made_with);
  for (std::string const& maker : makers) fmt::print("made with {}\n", maker);

  for (Shape* s : chosen) certify_phi(library, *s, a.options, s->certificate);
  fmt::print("\nmeasured now from phi\n{}", phi_table(copies(chosen)));
  std::unique_ptr<MeshTruth> const truth = measure_against(a, library, *chosen.front());
  if (truth) {
    fmt::print("\nmeasured now against the mesh\n{}", error_table(copies(chosen)));
    print_normals(truth->compare_normals(fast_phi(library, *chosen.front(), a.options.threads), a.options.points));
  }
  if (!a.plot.empty()) {
    std::string const trouble = plot_certificate(library, *chosen.front(), truth.get(), a.plot, a.options.threads);
    fmt::print("{}\n", trouble.empty() ? a.plot.string() + ": drawn" : "no picture: " + trouble);
  }
  if (!a.write) return exit_ok;
  write_model(a.file, library, true);
  fmt::print("{}: certificates of {} shapes written\n", a.file.string(), chosen.size());
  return exit_ok;
}

}  // namespace

void add_inspect(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<InspectArguments>();
  CLI::App* const c = app.add_subcommand("inspect", "Print certificates; measure gradients, interior, parts and nodes");
  c->add_option("file", a->file, "Model file (.h5)")->required();
  c->add_option("--shape", a->shape, "Only this shape");
  c->add_option("--mesh", a->mesh, "Closed mesh that the shape should be (.stl, .obj, .ply; any place, pose and unit)");
  c->add_option("--plot", a->plot, "Picture of the certificate (.png, .svg), with its data as CSV beside it");
  c->add_flag("--force", a->force, "Replace an existing picture");
  c->add_flag("--write", a->write,
              "Write what was measured, also against --mesh, into the file, for the gate of `scree run`");
  c->add_option("--nodes", a->options.nodes, "Surface nodes to measure")
      ->check(CLI::Range(4, 1000000))
      ->capture_default_str();
  c->add_option("--threads", a->options.threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c->callback([a, &chosen] { chosen = [a] { return inspect(*a); }; });
}

}  // namespace scree
