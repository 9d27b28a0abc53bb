// results_walls.cpp: see results_walls.h. Radii and formulas are there only where a wall has them.
// SPDX-License-Identifier: Apache-2.0
#include "core/results_walls.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "shapes/hdf5_handle.h"

namespace scree {
namespace {

using results_hdf5::as_vectors;
using results_hdf5::read_array;
using results_hdf5::write_array;

// In the order of WallSolidKind.
std::array<char const*, 9> constexpr kind_name{"plane",  "bore", "cylinder", "box",    "capsule",
                                               "funnel", "mesh", "sheet",    "terrain"};
std::array<AnalyticKind, 6> constexpr formula_of{AnalyticKind::plane, AnalyticKind::bore,    AnalyticKind::cylinder,
                                                 AnalyticKind::box,   AnalyticKind::capsule, AnalyticKind::funnel};

double const* numbers(std::vector<Vec3> const& v) { return v.empty() ? nullptr : &v[0].x; }

WallSolidKind kind_of(std::string const& name) {
  auto const at = std::find(kind_name.begin(), kind_name.end(), name);
  if (at == kind_name.end()) throw std::runtime_error("/wall_bodies: unknown kind '" + name + "'");
  return static_cast<WallSolidKind>(at - kind_name.begin());
}

// All triangles in two arrays, with the numbers of each body's vertices and triangles.
void write_meshes(hid_t group, std::vector<ResultsWallBody> const& wall) {
  std::vector<int> vertices, triangles, triangle;
  std::vector<Vec3> vertex;
  for (ResultsWallBody const& w : wall) {
    vertices.push_back(static_cast<int>(w.mesh.vertex.size()));
    triangles.push_back(static_cast<int>(w.mesh.triangle.size()));
    vertex.insert(vertex.end(), w.mesh.vertex.begin(), w.mesh.vertex.end());
    for (auto const& t : w.mesh.triangle) triangle.insert(triangle.end(), t.begin(), t.end());
  }
  write_array(group, "vertices", vertices.data(), {vertices.size()});
  write_array(group, "triangles", triangles.data(), {triangles.size()});
  write_array(group, "vertex", numbers(vertex), {vertex.size(), 3});
  write_array(group, "triangle", triangle.data(), {triangle.size() / 3, 3});
}

void read_meshes(hid_t group, std::vector<ResultsWallBody>& wall) {
  auto const vertices = read_array<int>(group, "vertices"), triangles = read_array<int>(group, "triangles");
  auto const vertex = as_vectors<Vec3>(read_array<double>(group, "vertex", {3}));
  auto const corner = read_array<int>(group, "triangle", {3});
  auto const fail = [] { throw std::runtime_error("/wall_bodies: the triangles contradict themselves"); };
  if (vertices.size() != wall.size() || triangles.size() != wall.size()) fail();
  std::size_t first_vertex = 0, first_triangle = 0;
  for (std::size_t w = 0; w < wall.size(); ++w) {
    if (vertices[w] < 0 || triangles[w] < 0 || first_vertex + vertices[w] > vertex.size() ||
        first_triangle + triangles[w] > corner.size() / 3)
      fail();
    wall[w].mesh.vertex.assign(vertex.begin() + first_vertex, vertex.begin() + first_vertex + vertices[w]);
    for (std::size_t t = first_triangle; t < first_triangle + triangles[w]; ++t) {
      for (int k = 0; k < 3; ++k)
        if (corner[3 * t + k] < 0 || corner[3 * t + k] >= vertices[w]) fail();
      wall[w].mesh.triangle.push_back({corner[3 * t], corner[3 * t + 1], corner[3 * t + 2]});
    }
    first_vertex += vertices[w];
    first_triangle += triangles[w];
    if (wall[w].kind >= WallSolidKind::mesh && triangles[w] == 0) fail();
  }
}

}  // namespace

void write_walls(hid_t file, std::vector<ResultsWall> const& wall) {
  hdf5::Handle const group = hdf5::create_group(file, "/walls");
  std::vector<std::string> name;
  std::vector<Vec3> point, normal;
  std::vector<double> radius;
  for (ResultsWall const& w : wall) {
    name.push_back(w.name);
    point.push_back(w.point);
    normal.push_back(w.normal);
    radius.push_back(w.radius);
  }
  results_hdf5::write_texts(group, "name", name);
  write_array(group, "point", numbers(point), {wall.size(), 3});
  write_array(group, "normal", numbers(normal), {wall.size(), 3});
  if (std::any_of(radius.begin(), radius.end(), [](double r) { return r > 0; }))
    write_array(group, "radius", radius.data(), {wall.size()});
}

std::vector<ResultsWall> read_walls(hid_t file) {
  hdf5::Handle const group = hdf5::open_group(file, "/walls");
  std::vector<std::string> const name = results_hdf5::read_texts(group, "name");
  auto const point = as_vectors<Vec3>(read_array<double>(group, "point", {3}));
  auto const normal = as_vectors<Vec3>(read_array<double>(group, "normal", {3}));
  std::vector<double> radius(name.size(), 0.0);
  if (hdf5::has_dataset(group, "radius")) radius = read_array<double>(group, "radius");
  if (point.size() != name.size() || normal.size() != name.size() || radius.size() != name.size())
    throw std::runtime_error("/walls: lengths differ");
  std::vector<ResultsWall> wall;
  for (std::size_t i = 0; i < name.size(); ++i) wall.push_back({name[i], point[i], normal[i], radius[i]});
  return wall;
}

void write_wall_bodies(hid_t file, std::vector<ResultsWallBody> const& wall) {
  if (wall.empty()) return;
  std::vector<std::string> name, kind;
  std::vector<std::uint8_t> inside, moving;
  std::vector<double> half_size, half_wall, position, orientation;
  for (ResultsWallBody const& w : wall) {
    bool const formula = w.kind < WallSolidKind::mesh;
    Vec3 const half = formula ? w.formula.half_size : Vec3{};
    name.push_back(w.name);
    kind.push_back(kind_name[static_cast<std::size_t>(w.kind)]);
    inside.push_back(w.inside);
    moving.push_back(w.moving);
    half_size.insert(half_size.end(), {half.x, half.y, half.z});
    half_wall.push_back(formula ? w.formula.half_wall : w.half_wall);
    position.insert(position.end(), {w.position.x, w.position.y, w.position.z});
    orientation.insert(orientation.end(), {w.orientation.w, w.orientation.x, w.orientation.y, w.orientation.z});
  }
  hdf5::Handle const group = hdf5::create_group(file, "/wall_bodies");
  results_hdf5::Extent const n{wall.size()};
  results_hdf5::write_texts(group, "name", name);
  results_hdf5::write_texts(group, "kind", kind);
  write_array(group, "inside", inside.data(), n);
  write_array(group, "moving", moving.data(), n);
  write_array(group, "half_size", half_size.data(), {wall.size(), 3});
  write_array(group, "half_wall", half_wall.data(), n);
  write_array(group, "position", position.data(), {wall.size(), 3});
  write_array(group, "orientation", orientation.data(), {wall.size(), 4});
  write_meshes(group, wall);
}

std::vector<ResultsWallBody> read_wall_bodies(hid_t file) {
  if (!hdf5::has_group(file, "/wall_bodies")) return {};
  hdf5::Handle const group = hdf5::open_group(file, "/wall_bodies");
  std::vector<std::string> const name = results_hdf5::read_texts(group, "name");
  std::vector<std::string> const kind = results_hdf5::read_texts(group, "kind");
  auto const inside = read_array<std::uint8_t>(group, "inside"), moving = read_array<std::uint8_t>(group, "moving");
  auto const half_size = as_vectors<Vec3>(read_array<double>(group, "half_size", {3}));
  auto const half_wall = read_array<double>(group, "half_wall");
  auto const position = as_vectors<Vec3>(read_array<double>(group, "position", {3}));
  auto const orientation = as_vectors<Quat>(read_array<double>(group, "orientation", {4}));
  std::size_t const n = name.size();
  if (kind.size() != n || inside.size() != n || moving.size() != n || half_size.size() != n || half_wall.size() != n ||
      position.size() != n || orientation.size() != n)
    throw std::runtime_error("/wall_bodies: lengths differ");
  std::vector<ResultsWallBody> wall(n);
  for (std::size_t i = 0; i < n; ++i) {
    ResultsWallBody& w = wall[i];
    w.name = name[i];
    w.kind = kind_of(kind[i]);
    w.inside = inside[i] != 0;
    w.moving = moving[i] != 0;
    if (w.kind < WallSolidKind::mesh) {
      w.formula.kind = formula_of[static_cast<std::size_t>(w.kind)];
      w.formula.half_size = half_size[i];
      w.formula.half_wall = half_wall[i];
    } else {
      w.half_wall = half_wall[i];
    }
    w.position = position[i];
    w.orientation = orientation[i];
  }
  read_meshes(group, wall);
  return wall;
}

std::size_t moving_walls(ResultsHeader const& header) {
  return std::count_if(header.wall_body.begin(), header.wall_body.end(),
                       [](ResultsWallBody const& w) { return w.moving; });
}

}  // namespace scree
