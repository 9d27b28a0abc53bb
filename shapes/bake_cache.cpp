// bake_cache.cpp: see bake_cache.h. A cached shape is a model file with one shape.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/bake_cache.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <type_traits>

#include "kernels/sdf/sdf_batch.h"
#include "shapes/bake.h"
#include "shapes/model_file.h"

namespace scree {
namespace {

char constexpr cached_name[] = "baked";
int constexpr recipe = 2;  // counts changes of bake.cpp that alter what is made

// FNV-1a, 64 bits (Fowler, Noll, Vo).
class Hash {
 public:
  template <class T>
  Hash& add(T const& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);  // padding must not count
    bytes(&value, sizeof(value));
    return *this;
  }
  Hash& add(Vec3 v) { return add(v.x).add(v.y).add(v.z); }
  Hash& add(std::string const& s) {
    bytes(s.data(), s.size());
    return add(s.size());
  }
  template <class T>
  Hash& add(std::vector<T> const& list) {
    for (T const& value : list) add(value);
    return add(list.size());
  }
  std::string digits() const {
    char text[17];
    std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(state_));
    return text;
  }

 private:
  void bytes(void const* from, std::size_t count) {
    auto const* const b = static_cast<unsigned char const*>(from);
    for (std::size_t i = 0; i < count; ++i) state_ = (state_ ^ b[i]) * 0x100000001b3ull;
  }
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

void add_query(Hash& hash, QueryTransform const& q) {
  for (Vec3 const& row : q.rotation.row) hash.add(row);
  hash.add(q.shift).add(q.scale);
}

void add_net(Hash& hash, Mlp const& net) {
  hash.add(sdf_isa()).add(net.activation).add(net.parameter).add(net.width).add(net.weight).add(net.bias);
}

void add_phi(Hash& hash, Library const& library, Shape const& s) {
  auto const data = static_cast<std::size_t>(s.data);
  hash.add(s.kind);
  switch (s.kind) {
    case ShapeKind::analytic:
      hash.add(s.analytic.kind).add(s.analytic.half_size).add(s.analytic.exponent_ns).add(s.analytic.exponent_ew);
      return;
    case ShapeKind::net:
      add_net(hash, library.net.at(static_cast<std::size_t>(s.net)));
      hash.add(s.code);
      return add_query(hash, s.query);
    case ShapeKind::harmonics:
      hash.add(library.harmonics.at(data));
      return add_query(hash, s.query);
    case ShapeKind::mesh: {
      TriangleMesh const& mesh = library.mesh.at(data)->mesh();
      hash.add(mesh.vertex);
      for (auto const& t : mesh.triangle) hash.add(t[0]).add(t[1]).add(t[2]);
      return;
    }
    case ShapeKind::grid: {
      GridFrame const& f = library.grid.at(data)->frame;
      hash.add(f.origin).add(f.cell).add(f.nx).add(f.ny).add(f.nz).add(library.grid[data]->value);
      return;
    }
  }
}

Library bake(Library const& library, Shape const& source, BakeRequest const& request) {
  switch (request.kind) {
    case ShapeKind::grid:
      return bake_grid(library, source, request.cells, request.threads);
    case ShapeKind::mesh:
      return bake_mesh(library, source, request.cells, request.threads);
    default:
      throw std::invalid_argument("only grids and meshes are baked");
  }
}

// Two shapes may share a phi but not a name: what a file holds is phi and its bounds.
Library with_identity_of(Shape const& source, Library baked) {
  Shape& s = baked.shape.at(0);
  Shape merged = source;
  merged.kind = s.kind, merged.data = s.data;
  merged.box = s.box, merged.bounding_radius = s.bounding_radius, merged.lipschitz = s.lipschitz;
  s = merged;
  return baked;
}

void add_note(std::vector<std::string>& notes, std::string const& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

void keep(std::filesystem::path const& file, Library baked, std::vector<std::string>& notes) {
  baked.shape[0].name = cached_name;
  try {
    std::filesystem::create_directories(file.parent_path());
    write_model(file, baked, true);
  } catch (std::exception const&) {
    add_note(notes, "baked shapes are not kept: " + file.parent_path().string() +
                        " cannot be written; point SCREE_CACHE to a folder that can");
  }
}

}  // namespace

std::filesystem::path bake_cache_folder() {
  auto const variable = [](char const* name) {
    char const* const value = std::getenv(name);
    return std::filesystem::path(value ? value : "");
  };
  if (std::filesystem::path const own = variable("SCREE_CACHE"); !own.empty()) return own;
  if (std::filesystem::path const xdg = variable("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "scree";
  if (std::filesystem::path const home = variable("HOME"); home.is_absolute()) return home / ".cache" / "scree";
  return {};
}

std::string bake_key(Library const& library, Shape const& source, BakeRequest const& request) {
  Hash hash;
  hash.add(recipe).add(request.kind).add(request.cells);
  hash.add(source.bounding_radius).add(source.box.min).add(source.box.max);
  add_phi(hash, library, source);
  return hash.digits();
}

Library cached_bake(Library const& library, Shape const& source, BakeRequest const& request,
                    std::vector<std::string>& notes) {
  std::filesystem::path const folder = bake_cache_folder();
  std::filesystem::path const file = folder / (bake_key(library, source, request) + ".h5");
  std::error_code error;
  if (!folder.empty() && std::filesystem::exists(file, error)) {
    try {
      Library cached = read_model(file);
      if (cached.shape.size() == 1 && cached.shape[0].kind == request.kind) return with_identity_of(source, cached);
    } catch (std::exception const&) {
      add_note(notes, file.string() + " is damaged and is made again");
    }
  }
  Library const baked = bake(library, source, request);
  if (folder.empty())
    add_note(notes, "baked shapes are not kept: neither SCREE_CACHE nor HOME names a folder");
  else
    keep(file, baked, notes);
  return with_identity_of(source, baked);
}

}  // namespace scree
