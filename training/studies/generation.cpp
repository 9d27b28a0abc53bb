// generation.cpp: shapes between codes and shapes drawn from a category's codes, Figs. 17 to 19.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "shapes/descriptors.h"
#include "shapes/latent.h"
#include "shapes/mesh_normalise.h"
#include "training/studies/csv_file.h"
#include "training/studies/pictures.h"
#include "training/studies/recipes.h"

namespace scree {
namespace {

Shape const& named(Library const& library, std::string const& name) {
  for (Shape const& shape : library.shape)
    if (shape.name == name) return shape;
  throw std::invalid_argument("the library has no shape " + name);
}

// What a decoder makes of a code: its surface, and its form; zeros where there is no solid.
struct Decoded {
  TriangleMesh mesh;
  MeshMass mass;
  Descriptors form;
  int components = 0;
};
Decoded decode(StudyOptions const& options, Library const& library, std::vector<float> const& code) {
  Shape shape = library.shape[0];
  shape.code = code;
  double radius = 0;
  for (Shape const& s : library.shape) radius = std::max(radius, 1.1 * s.bounding_radius);
  ZeroSet const surface = picture_surface(options, fast_phi(library, shape, options.threads), radius);
  Decoded result;
  result.mesh = surface.mesh;
  result.components = surface.components;
  result.mass = mesh_mass(result.mesh);
  if (result.mass.volume > 0) result.form = describe(normalised(result.mesh));
  return result;
}

}  // namespace

// Strips of shapes with a description: within sand and ballast (Fig. 17), then round the four categories (Fig. 18).
void study_interpolation(StudyOptions const& options) {
  Library const library = grain_library(options);
  CsvFile csv(options.folder / "interpolation.csv", {"from", "to", "position", "volume", "sphericity", "convexity",
                                                     "elongation", "flatness", "components", "mesh"});
  int const steps = options.quick ? 2 : 6;
  std::vector<std::pair<std::string, std::string>> const strips{
      {"sand/0", "sand/4"},      {"ballast/0", "ballast/4"},   {"sand/2", "cobble/2"},
      {"cobble/2", "ballast/2"}, {"ballast/2", "ellipsoid/2"}, {"ellipsoid/2", "sand/2"}};
  for (auto const& [from, to] : strips)
    for (int i = 0; i <= steps; ++i) {
      double const t = static_cast<double>(i) / steps;
      Decoded const d = decode(options, library, interpolate_codes(named(library, from), named(library, to), t));
      csv.row(from, to, t, d.mass.volume, d.form.sphericity, d.form.convexity, d.form.elongation, d.form.flatness,
              d.components, write_picture_mesh(options, fmt::format("between-{}-{}-{}", from, to, i), d.mesh));
    }
}

// The codes of the 20 grains, and draws from each category's Gaussian, cut off at two standard deviations.
void study_latent(StudyOptions const& options) {
  Library const library = grain_library(options);
  int const drawn = options.quick ? 4 : 40, pictured = 4;
  std::vector<std::string> columns{"kind",      "category",   "name",     "volume",     "sphericity",
                                   "convexity", "elongation", "flatness", "components", "mesh"};
  int const size = static_cast<int>(library.shape[0].code.size());
  for (int k = 0; k < size; ++k) columns.push_back(fmt::format("z{}", k));
  CsvFile csv(options.folder / "latent.csv", columns);
  auto const add = [&](std::string const& kind, std::string const& category, std::string const& name,
                       std::vector<float> const& code, bool picture) {
    Decoded const d = decode(options, library, code);
    std::vector<std::string> row{kind, category, name};
    for (double v : {d.mass.volume, d.form.sphericity, d.form.convexity, d.form.elongation, d.form.flatness})
      row.push_back(CsvFile::text(v));
    row.push_back(CsvFile::text(d.components));
    row.push_back(picture ? write_picture_mesh(options, kind + "-" + name, d.mesh) : "");
    for (float z : code) row.push_back(CsvFile::text(z));
    csv.write(row);
  };
  Random random(19);
  double constexpr truncate = 2;
  for (Shape const& shape : library.shape) add("trained", category_of(shape.name), shape.name, shape.code, false);
  for (std::string const& category : coded_categories(library)) {
    CodeGaussian const gaussian = fit_codes(library, category);
    for (int i = 0; i < drawn; ++i)
      add("drawn", category, fmt::format("{}/{}", category, i), draw_code(gaussian, truncate, random), i < pictured);
  }
}

}  // namespace scree
