// dataset_files.cpp: the benchmark sets as mesh files with a table of their form.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/dataset_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/descriptors.h"
#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh/procedural_grains.h"
#include "shapes/mesh_files.h"
#include "training/studies/csv_file.h"
#include "training/studies/superellipsoid_set.h"

namespace scree {
namespace {

std::string file_name(std::string shape) {
  std::replace(shape.begin(), shape.end(), '/', '-');
  return shape + ".stl";
}

// All are convex and of volume pi/6, so that sphericity is the area pi of the sphere over theirs.
int write_superellipsoids(std::filesystem::path const& folder, CsvFile& csv, int cells) {
  std::vector<SetSuperellipsoid> const set = superellipsoid_set();
  for (SetSuperellipsoid const& s : set) {
    TriangleMesh const mesh = superellipsoid_mesh(s.shape, cells);
    write_mesh(folder / file_name(s.shape.name), mesh);
    Vec3 const half = s.shape.analytic.half_size;
    double const inscribed = signed_distance(s.shape.analytic, {0, 0, 0}, nullptr);
    csv.row(s.shape.name, 2 * half.x, 2 * half.y, 2 * half.z, s.exponent, s.shape.volume, mesh_mass(mesh).volume,
            s.shape.area, std::numbers::pi / s.shape.area, 1, s.elongation, s.flatness, inscribed,
            s.shape.bounding_radius, static_cast<int>(mesh.triangle.size()),
            fmt::format("superellipsoid exponents {}", s.exponent));
  }
  return static_cast<int>(set.size());
}

int write_grains(std::filesystem::path const& folder, CsvFile& csv) {
  std::vector<ProceduralGrain> const grains = procedural_grains();
  for (ProceduralGrain const& g : grains) {
    write_mesh(folder / file_name(g.name), g.mesh);
    MeshMass const mass = mesh_mass(g.mesh);
    Descriptors const d = describe(g.mesh);
    Vec3 low = g.mesh.vertex[0], high = low;
    double bounding = 0;
    for (Vec3 const& v : g.mesh.vertex) {
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], v[k]), high[k] = std::max(high[k], v[k]);
      bounding = std::max(bounding, norm(v));
    }
    csv.row(g.name, high.x - low.x, high.y - low.y, high.z - low.z, "", mass.volume, mass.volume, mass.area,
            d.sphericity, d.convexity, d.elongation, d.flatness, std::max(MeshDistance(g.mesh).at({0, 0, 0}).phi, 0.0),
            bounding, static_cast<int>(g.mesh.triangle.size()), g.formula);
  }
  return static_cast<int>(grains.size());
}

}  // namespace

std::vector<std::string> const& dataset_names() {
  static std::vector<std::string> const names{"superellipsoids125", "grains20"};
  return names;
}

int write_dataset(std::string const& name, std::filesystem::path const& folder, int cells) {
  if (std::find(dataset_names().begin(), dataset_names().end(), name) == dataset_names().end())
    throw std::invalid_argument(fmt::format("no data set '{}'; there are {}", name, fmt::join(dataset_names(), ", ")));
  CsvFile csv(folder / (name + ".csv"),
              {"shape", "size_x", "size_y", "size_z", "exponent", "volume", "mesh_volume", "area", "sphericity",
               "convexity", "elongation", "flatness", "inscribed_radius", "bounding_radius", "triangles", "formula"});
  return name == "grains20" ? write_grains(folder, csv) : write_superellipsoids(folder, csv, cells);
}

}  // namespace scree
