// scene_evaluators.cpp: see scene_evaluators.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/scene_evaluators.h"

#include <algorithm>

#include "core/unique_grains.h"
#include "shapes/bake_cache.h"

namespace scree {
namespace {

template <class T>
void append(std::vector<T>& to, Span<const T> from) {
  to.insert(to.end(), from.begin(), from.end());
}

// Index of a shared part in a list of the scene's library; -1: not there yet.
template <class T>
int index_of(std::vector<T> const& list, T const& part) {
  auto const at = std::find(list.begin(), list.end(), part);
  return at == list.end() ? -1 : static_cast<int>(at - list.begin());
}

}  // namespace

ShapeRecord record_of(Shape const& shape) {
  ShapeRecord r;
  r.closed_form_sphere = shape.kind == ShapeKind::analytic && shape.analytic.kind == AnalyticKind::sphere;
  r.analytic = shape.analytic;
  r.query_rotation = shape.query.rotation;
  r.query_shift = shape.query.shift;
  r.query_scale = shape.query.scale;
  r.bounding_radius = shape.bounding_radius;
  r.box = shape.box;
  // Boxes of formulas, grids and meshes are exact.
  if (shape.is_net() || shape.kind == ShapeKind::harmonics)
    for (int k = 0; k < 3; ++k) r.box.min[k] -= box_slack, r.box.max[k] += box_slack;
  r.lipschitz = std::max(1.0, shape.lipschitz);
  return r;
}

int SceneEvaluators::place_net(int library, int net) {
  auto const [at, fresh] = net_.emplace(std::pair{library, net}, -1);
  if (fresh) at->second = scene_network(scene_, libraries_[library].net[net]);  // entries may share a decoder
  return at->second;
}

int SceneEvaluators::place_harmonics(int library, int data) {
  auto const [at, fresh] =
      harmonics_.emplace(std::pair{library, data}, static_cast<int>(scene_.library.harmonics.size()));
  if (fresh) {
    std::vector<double> const& c = libraries_[library].harmonics[data];
    scene_.library.harmonics.push_back(c);
    first_coefficient_.push_back(static_cast<int>(scene_.coefficient.size()));
    append<double>(scene_.coefficient, c);
  }
  return at->second;
}

int SceneEvaluators::place_mesh(std::shared_ptr<MeshTree const> const& mesh) {
  if (int const known = index_of(scene_.library.mesh, mesh); known >= 0) return known;
  MeshSdf const sdf = mesh->sdf();
  mesh_place_.push_back({static_cast<int>(scene_.mesh_node.size()), static_cast<int>(scene_.mesh_corner.size() / 3)});
  append(scene_.mesh_node, sdf.node);
  append(scene_.mesh_corner, sdf.corner);
  append(scene_.mesh_normal, sdf.normal);
  scene_.library.mesh.push_back(mesh);
  return static_cast<int>(scene_.library.mesh.size()) - 1;
}

int SceneEvaluators::place_grid(std::shared_ptr<SdfGrid const> const& grid) {
  if (int const known = index_of(scene_.library.grid, grid); known >= 0) return known;
  first_value_.push_back(scene_.grid_value.size());
  append<float>(scene_.grid_value, grid->value);
  scene_.library.grid.push_back(grid);
  return static_cast<int>(scene_.library.grid.size()) - 1;
}

Library const& SceneEvaluators::baked(int library, int shape, ShapeKind kind, int cells) {
  auto const [at, fresh] = baked_.try_emplace({library, shape, kind, cells});
  if (fresh) {
    Library const& from = libraries_[library];
    at->second = cached_bake(from, from.shape[shape], {kind, cells, threads_}, scene_.notes);
  }
  return at->second;
}

ShapeRecord SceneEvaluators::add(int library, int shape, ShapeKind kind, int cells, Shape& out) {
  std::string const name = out.name;
  Library const& from = cells > 0 ? baked(library, shape, kind, cells) : libraries_[library];
  out = cells > 0 ? from.shape[0] : from.shape[shape];
  out.name = name;
  ShapeRecord record = record_of(out);
  switch (kind) {
    case ShapeKind::analytic:
      record.sdf = SdfKind::analytic;
      break;
    case ShapeKind::net: {
      record.sdf = SdfKind::net;
      record.net = out.net = place_net(library, out.net);
      PackedMlp const& packed = scene_.networks.net[out.net];
      record.bias_row = packed.append_bias(fold_code(packed.net(), out.code), scene_.networks.bias_rows[out.net]);
      break;
    }
    case ShapeKind::harmonics:
      record.sdf = SdfKind::harmonics;
      out.data = place_harmonics(library, out.data);
      record.first_coefficient = first_coefficient_[out.data];
      record.coefficients = static_cast<int>(scene_.library.harmonics[out.data].size());
      break;
    case ShapeKind::mesh: {
      record.sdf = SdfKind::mesh;
      MeshSdf const sdf = from.mesh[out.data]->sdf();
      out.data = place_mesh(from.mesh[out.data]);
      record.first_mesh_node = mesh_place_[out.data].first_node;
      record.first_triangle = mesh_place_[out.data].first_triangle;
      record.mesh_nodes = sdf.node.size();
      record.triangles = sdf.corner.size() / 3;
      break;
    }
    case ShapeKind::grid:
      record.sdf = SdfKind::grid;
      record.grid = from.grid[out.data]->frame;
      out.data = place_grid(from.grid[out.data]);
      record.first_value = first_value_[out.data];
      break;
  }
  return record;
}

}  // namespace scree
