// model_parts.cpp: see model_parts.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/model_parts.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace scree {
namespace {

std::string part_path(char const* list, std::size_t k) { return "/" + std::string(list) + "/" + std::to_string(k); }

void write_harmonics(hid_t group, std::vector<double> const& c) {
  hdf5::write_table<double>(group, "coefficients", {c, static_cast<int>(c.size()), -1});
}
std::vector<double> read_harmonics(hid_t group) { return hdf5::read_table<double>(group, "coefficients", 1).value; }

void write_mesh_part(hid_t group, std::shared_ptr<MeshTree const> const& tree) {
  TriangleMesh const& mesh = tree->mesh();
  hdf5::Table<double> vertex{{}, static_cast<int>(mesh.vertex.size()), 3};
  for (Vec3 const& v : mesh.vertex) vertex.value.insert(vertex.value.end(), {v.x, v.y, v.z});
  hdf5::Table<int> triangle{{}, static_cast<int>(mesh.triangle.size()), 3};
  for (auto const& t : mesh.triangle) triangle.value.insert(triangle.value.end(), t.begin(), t.end());
  hdf5::write_table(group, "vertex", vertex);
  hdf5::write_table(group, "triangle", triangle);
}
std::shared_ptr<MeshTree const> read_mesh_part(hid_t group) {
  hdf5::Table<double> const vertex = hdf5::read_table<double>(group, "vertex", 2);
  hdf5::Table<int> const triangle = hdf5::read_table<int>(group, "triangle", 2);
  if (vertex.columns != 3 || triangle.columns != 3)
    throw std::runtime_error("its vertices and triangles must have three numbers each");
  TriangleMesh mesh;
  for (int i = 0; i < vertex.rows; ++i) {
    double const* const v = &vertex.value[3 * std::size_t(i)];
    mesh.vertex.push_back({v[0], v[1], v[2]});
  }
  for (int i = 0; i < triangle.rows; ++i) {
    int const* const t = &triangle.value[3 * std::size_t(i)];
    mesh.triangle.push_back({t[0], t[1], t[2]});
  }
  return std::make_shared<MeshTree const>(std::move(mesh));
}

void write_grid(hid_t group, std::shared_ptr<SdfGrid const> const& grid) {
  GridFrame const& f = grid->frame;
  double const points[3] = {double(f.nx), double(f.ny), double(f.nz)};
  hdf5::write_attribute(group, "origin", &f.origin.x, 3);
  hdf5::write_attribute(group, "cell", &f.cell, 1);
  hdf5::write_attribute(group, "points", points, 3);
  hdf5::write_floats(group, "values", {grid->value, f.ny * f.nz, f.nx});
}
std::shared_ptr<SdfGrid const> read_grid(hid_t group) {
  SdfGrid grid;
  std::vector<double> const origin = hdf5::read_doubles(group, "origin", 3);
  std::vector<double> const points = hdf5::read_doubles(group, "points", 3);
  for (double n : points)
    if (!(n >= 2 && n <= 4096)) throw std::runtime_error("attribute 'points' is out of range");
  hdf5::FloatArray values = hdf5::read_floats(group, "values", 2);
  grid.frame.origin = {origin[0], origin[1], origin[2]};
  grid.frame.cell = hdf5::read_doubles(group, "cell", 1)[0];
  grid.frame.nx = static_cast<int>(points[0]);
  grid.frame.ny = static_cast<int>(points[1]);
  grid.frame.nz = static_cast<int>(points[2]);
  if (values.columns != grid.frame.nx || values.rows != grid.frame.ny * grid.frame.nz)
    throw std::runtime_error("its values do not have the size that 'points' promises");
  grid.value = std::move(values.value);
  return std::make_shared<SdfGrid const>(std::move(grid));
}

template <class T>
void write_list(hid_t file, char const* list, std::vector<T> const& parts, void (*write)(hid_t, T const&)) {
  for (std::size_t k = 0; k < parts.size(); ++k) write(hdf5::create_group(file, part_path(list, k)), parts[k]);
}
template <class T>
void read_list(hid_t file, char const* list, std::vector<T>& parts, T (*read)(hid_t)) {
  if (!hdf5::has_group(file, "/" + std::string(list))) return;
  for (std::size_t k = 0; hdf5::has_group(file, part_path(list, k)); ++k) {
    try {
      parts.push_back(read(hdf5::open_group(file, part_path(list, k))));
    } catch (std::exception const& e) {
      throw std::runtime_error(part_path(list, k) + ": " + e.what());
    }
  }
}

}  // namespace

bool has_model_parts(Library const& library) {
  return !library.harmonics.empty() || !library.mesh.empty() || !library.grid.empty();
}

void write_model_parts(hid_t file, Library const& library) {
  write_list(file, "harmonics", library.harmonics, write_harmonics);
  write_list(file, "mesh", library.mesh, write_mesh_part);
  write_list(file, "grid", library.grid, write_grid);
}

void read_model_parts(hid_t file, Library& library) {
  read_list(file, "harmonics", library.harmonics, read_harmonics);
  read_list(file, "mesh", library.mesh, read_mesh_part);
  read_list(file, "grid", library.grid, read_grid);
}

}  // namespace scree
