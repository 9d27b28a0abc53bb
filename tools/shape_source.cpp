// shape_source.cpp: see shape_source.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/shape_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_samples.h"
#include "shapes/model_file.h"
#include "shapes/text_lines.h"
#include "tools/shape_input.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

int constexpr truth_cells = 64;  // marched cells across the ball; once refined, chords err by 1e-4 d

ShapeSource from_model(fs::path const& file, std::string const& name, int threads) {
  auto const library = std::make_shared<Library const>(read_model(file));
  std::vector<std::string> names;
  Shape const* shape = nullptr;
  for (Shape const& s : library->shape) {
    names.push_back(s.name);
    if (s.name == name || (name.empty() && library->shape.size() == 1)) shape = &s;
  }
  if (!shape)
    throw std::invalid_argument(fmt::format("{}{}; choose with --shape one of: {}", file.string(),
                                            name.empty() ? " has several shapes" : " has no shape '" + name + "'",
                                            fmt::join(names, ", ")));
  ShapeSource source;
  source.title = file.string() + ", " + shape->name;
  source.unit = "d";
  source.phi = [library, phi = surface_phi(*library, *shape, threads)](
                   Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) { phi(x, value, gradient); };
  source.domain.radius = 1.1 * shape->bounding_radius;
  source.domain.lipschitz = surface_lipschitz(*shape);
  source.volume = shape->volume;
  return source;
}

ShapeSource from_mesh(fs::path const& file, int threads) {
  ShapeSource source;
  source.title = file.string();
  source.mesh = read_mesh(file);
  MeshReport const report = check_mesh(source.mesh, false);
  if (!report.defects.empty()) throw std::invalid_argument(file.string() + ": " + report.defects.front());
  MeshMass const mass = mesh_mass(source.mesh);
  source.centre = mass.centroid;
  source.volume = mass.volume;
  move_by(source.mesh, -mass.centroid);
  for (Vec3 const& v : source.mesh.vertex) source.domain.radius = std::max(source.domain.radius, 1.1 * norm(v));
  source.domain.lipschitz = 1;
  auto const distance = std::make_shared<MeshDistance const>(source.mesh);
  source.phi = [distance, threads](Span<const Vec3> x, Span<double> value, Span<Vec3> gradient) {
    distance->evaluate(x, value, gradient, threads);
  };
  return source;
}

ShapeSource from_points(fs::path const& file) {
  ShapeSource source;
  source.title = file.string();
  source.cloud = read_points(file);
  for (Vec3 const& p : source.cloud.position) source.centre += p / static_cast<double>(source.cloud.position.size());
  move_by(source.cloud, -source.centre);
  return source;
}

}  // namespace

ShapeSource open_source(fs::path const& file, std::string const& shape, int threads) {
  std::string const extension = lower_extension(file);
  if (extension != ".h5" && extension != ".xyz" && !is_mesh_file(file))
    throw std::invalid_argument(file.string() +
                                ": unknown format; models are .h5, meshes .stl, .obj, .ply, points .ply, .xyz");
  return read_input([&] {
    if (extension == ".h5") return from_model(file, shape, threads);
    if (!shape.empty()) throw std::invalid_argument(file.string() + " is no model file: --shape does not apply");
    return holds_points(file) ? from_points(file) : from_mesh(file, threads);
  });
}

PointCloud surface_points(ShapeSource const& source, int count, SampleSpread spread) {
  if (spread == SampleSpread::area && !source.mesh.triangle.empty()) return sample_mesh(source.mesh, count);
  SurfaceSamples samples = sample_surface(source.phi, source.domain, count, spread);
  fmt::print("  projection: {}\n", to_string(samples.projection));
  return std::move(samples.cloud);
}

TriangleMesh truth_mesh(ShapeSource const& source) {
  if (!source.mesh.triangle.empty()) return source.mesh;
  ZeroSetOptions options = source.domain;
  options.cells = truth_cells;
  return refine(source.phi, find_zero_set(source.phi, options)).mesh;
}

void move_by(TriangleMesh& mesh, Vec3 by) {
  for (Vec3& v : mesh.vertex) v += by;
}
void move_by(PointCloud& cloud, Vec3 by) {
  for (Vec3& p : cloud.position) p += by;
}

}  // namespace scree
