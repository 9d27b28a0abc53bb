// shape_reconstruct.cpp: `scree-shape reconstruct`: a triangle mesh from phi, from another mesh, or from points; or the
// harmonics themselves as a model file.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/certify_phi.h"
#include "shapes/harmonic_shape.h"
#include "shapes/harmonics_fit.h"
#include "shapes/mesh/alpha_shape.h"
#include "shapes/mesh/certify_mesh.h"
#include "shapes/mesh/harmonics_mesh.h"
#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/mesh_compare.h"
#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh/untangle.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "shapes/text_lines.h"
#include "tools/certificate_table.h"
#include "tools/guarded.h"
#include "tools/shape_commands.h"
#include "tools/shape_input.h"
#include "tools/shape_source.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct ReconstructArguments {
  fs::path source, output;
  std::string shape, name, method = "alpha";
  int points = 4000, degree = 10, cells = 48, samples = 10000, threads = 2;
  double alpha = 0;  // 0: chosen
  bool force = false;
};

std::vector<Vec3> points_of(ShapeSource const& source, int count, SampleSpread spread) {
  if (source.is_cloud()) return source.cloud.position;
  try {
    return surface_points(source, count, spread).position;
  } catch (std::invalid_argument const& error) {
    throw std::invalid_argument(source.title + ": " + error.what() + "; use --method alpha or marching");
  }
}

// One ball rolls over all of the surface, so the points are even over its area.
TriangleMesh by_alpha(ShapeSource const& source, ReconstructArguments const& a) {
  AlphaShape const shape = alpha_shape(points_of(source, a.points, SampleSpread::area), a.alpha);
  fmt::print("  alpha {:.6g} {}^2 (ball of radius {:.4g} {}); one solid with all points from {:.6g} {}^2 on\n",
             shape.alpha, source.unit, std::sqrt(shape.alpha), source.unit, shape.smallest, source.unit);
  std::vector<std::string> const defects = check_mesh(shape.mesh, false).defects;
  if (shape.parts != 1 || shape.points_outside > 0 || !defects.empty())
    throw std::invalid_argument(
        fmt::format("{}: --alpha {:g} leaves {} parts and {} points outside{}{}; it takes {:.6g} or more", source.title,
                    a.alpha, shape.parts, shape.points_outside, defects.empty() ? "" : "; ",
                    defects.empty() ? "" : defects.front(), shape.smallest));
  return shape.mesh;
}

std::vector<double> harmonics_of(ShapeSource const& source, ReconstructArguments const& a) {
  std::vector<Vec3> const point = points_of(source, a.points, SampleSpread::directions);
  HarmonicsFit const fit = fit_harmonics(point, a.degree);
  fmt::print("  degree {}: {} coefficients, radii off by {:.2e} {} (rms), {:.2e} at most\n", a.degree,
             fit.coefficient.size(), fit.rms, source.unit, fit.largest);
  return fit.coefficient;
}

// A model file: normalised, certified against the source where that has a surface.
int write_harmonics(ShapeSource const& source, ReconstructArguments const& a) {
  std::string name = !a.name.empty() ? a.name : !a.shape.empty() ? a.shape : a.source.stem().string();
  Library library;
  Shape& shape = library.shape[add_harmonic_shape(library, name, harmonics_of(source, a), a.threads)];
  shape.certificate.source += " from " + a.source.filename().string();
  if (!source.is_cloud()) {
    MeshTruth const truth(truth_mesh(source), library, shape, a.threads);
    truth.certify(fast_phi(library, shape, a.threads), shape, a.samples, 1, shape.certificate);
  }
  certify_phi(library, shape, {.threads = a.threads}, shape.certificate);
  fmt::print("{}\n{}", error_table(library.shape), phi_table(library.shape));
  write_model(a.output, library, a.force);
  fmt::print("{}: shape {}, its equal-volume sphere has diameter 1\n", a.output.string(), name);
  return exit_ok;
}

TriangleMesh by_marching(ShapeSource const& source, ReconstructArguments const& a) {
  if (source.is_cloud())
    throw std::invalid_argument(source.title + ": --method marching needs phi: a model or a mesh; use --method alpha");
  ZeroSetOptions options = source.domain;
  options.cells = a.cells;
  ZeroSet const set = refine(source.phi, find_zero_set(source.phi, options));
  fmt::print("  {} part{}, |phi| at vertices at most {:.1e} {}\n", set.components, set.components == 1 ? "" : "s",
             set.worst_phi, source.unit);
  // Beside edges sharper than a cell vertices that were moved onto phi = 0 may have passed each other.
  TriangleMesh mesh = set.mesh;
  Untangled const u = untangle(mesh);
  if (u.vertices > 0)
    fmt::print("  {} vertices beside sharp edges moved by at most {:.1e} {}, where the surface cut through itself\n",
               u.vertices, u.farthest, source.unit);
  if (!u.is_simple)
    fmt::print("  the surface still cuts through itself: import refuses it; use more --cells, or --method alpha\n");
  return mesh;
}

void report(ShapeSource const& source, TriangleMesh const& mesh, ReconstructArguments const& a) {
  if (source.is_cloud()) {
    std::vector<double> phi(source.cloud.position.size());
    MeshDistance(mesh).evaluate(source.cloud.position, phi, {}, a.threads);
    double farthest = 0;
    for (double x : phi) farthest = std::max(farthest, std::abs(x));
    fmt::print("  farthest point from the mesh {:.2e} {}, volume {:.6g} {}^3\n", farthest, source.unit,
               mesh_mass(mesh).volume, source.unit);
    return;
  }
  MeshDifference const d = compare_meshes(mesh, truth_mesh(source), a.samples, a.threads);
  fmt::print("  Hausdorff distance {:.2e} {} (mean {:.1e}), volume {:+.2e}\n", d.hausdorff, source.unit, d.mean,
             mesh_mass(mesh).volume / source.volume - 1);
}

int reconstruct(ReconstructArguments const& a) {
  bool const model = a.method == "harmonics" && lower_extension(a.output) == ".h5";
  if (!is_mesh_file(a.output) && !model)
    throw std::invalid_argument(a.output.string() +
                                ": write a .stl, .obj or .ply file (with --method harmonics also .h5)");
  if (!model && !a.name.empty()) throw std::invalid_argument("--name is for a model file (.h5): meshes have no names");
  check_output(a.output, a.force);
  ShapeSource const source = open_source(a.source, a.shape, a.threads);
  fmt::print("{}: by {}\n", source.title, a.method);
  if (model) return write_harmonics(source, a);
  TriangleMesh mesh = a.method == "alpha"       ? by_alpha(source, a)
                      : a.method == "harmonics" ? harmonics_mesh(harmonics_of(source, a), a.points)
                                                : by_marching(source, a);
  report(source, mesh, a);
  move_by(mesh, source.centre);
  write_mesh(a.output, mesh);
  fmt::print("{}: {} triangles\n", a.output.string(), mesh.triangle.size());
  return exit_ok;
}

}  // namespace

void add_reconstruct(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<ReconstructArguments>();
  CLI::App* const c =
      app.add_subcommand("reconstruct", "Make a mesh of a model's shape, another mesh or a point cloud");
  c->add_option("source", a->source, "Model (.h5), closed mesh (.stl, .obj, .ply) or points (.ply, .xyz)")->required();
  c->add_option("-o,--output", a->output, "Mesh to write (.stl, .obj, .ply); harmonics: also a model file (.h5)")
      ->required();
  c->add_option("--shape", a->shape, "Shape of the model");
  c->add_option("--name", a->name, "Name of the shape in a model file (default: the source's)");
  c->add_option("--method", a->method, "alpha: any body; harmonics: smooth, star-shaped; marching: from phi")
      ->check(CLI::IsMember({"alpha", "harmonics", "marching"}))
      ->capture_default_str();
  c->add_option("--points", a->points, "Surface points (alpha, harmonics)")
      ->check(CLI::Range(100, 200000))
      ->capture_default_str();
  c->add_option("--alpha", a->alpha, "Square of the ball's radius (default: the smallest that gives one solid)")
      ->check(CLI::PositiveNumber);
  c->add_option("--degree", a->degree, "Of the harmonics")->check(CLI::Range(0, 20))->capture_default_str();
  c->add_option("--cells", a->cells, "Marched cells across the body")->check(CLI::Range(8, 400))->capture_default_str();
  c->add_option("--samples", a->samples, "Points of each surface that the result is measured at")
      ->check(CLI::Range(100, 1000000))
      ->capture_default_str();
  c->add_option("--threads", a->threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c->add_flag("--force", a->force, "Replace an existing output file");
  c->callback([a, &chosen] { chosen = [a] { return reconstruct(*a); }; });
}

}  // namespace scree
