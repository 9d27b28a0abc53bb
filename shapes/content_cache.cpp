// content_cache.cpp: see content_cache.h. What is kept is a model file.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/content_cache.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "kernels/sdf/sdf_batch.h"
#include "shapes/model_file.h"

namespace scree {
namespace {

void add_query(ContentHash& hash, QueryTransform const& q) {
  for (Vec3 const& row : q.rotation.row) hash.add(row);
  hash.add(q.shift).add(q.scale);
}

void add_net(ContentHash& hash, Mlp const& net) {
  hash.add(sdf_isa()).add(net.activation).add(net.parameter).add(net.width).add(net.weight).add(net.bias);
}

char const* variable(char const* name) {
  char const* const value = std::getenv(name);
  return value ? value : "";
}

bool switched_off() {
  char const* const own = std::getenv("SCREE_CACHE");
  return own && !*own;
}

std::filesystem::path file_of(std::filesystem::path const& folder, std::string const& key) {
  return folder / (key + ".h5");
}

void add_note(std::vector<std::string>& notes, std::string const& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

}  // namespace

ContentHash& ContentHash::add_phi(Library const& library, Shape const& s) {
  auto const data = static_cast<std::size_t>(s.data);
  add(s.kind);
  switch (s.kind) {
    case ShapeKind::analytic:
      return add(s.analytic.kind).add(s.analytic.half_size).add(s.analytic.exponent_ns).add(s.analytic.exponent_ew);
    case ShapeKind::net:
      add_net(*this, library.net.at(static_cast<std::size_t>(s.net)));
      add(s.code);
      add_query(*this, s.query);
      return *this;
    case ShapeKind::harmonics:
      add(library.harmonics.at(data));
      add_query(*this, s.query);
      return *this;
    case ShapeKind::mesh: {
      TriangleMesh const& mesh = library.mesh.at(data)->mesh();
      add(mesh.vertex);
      for (auto const& t : mesh.triangle) add(t[0]).add(t[1]).add(t[2]);
      return *this;
    }
    case ShapeKind::grid: {
      GridFrame const& f = library.grid.at(data)->frame;
      return add(f.origin).add(f.cell).add(f.nx).add(f.ny).add(f.nz).add(library.grid[data]->value);
    }
  }
  return *this;  // unreachable: every kind is listed
}

std::string ContentHash::digits() const {
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(state_));
  return text;
}

void ContentHash::bytes(void const* from, std::size_t count) {
  auto const* const b = static_cast<unsigned char const*>(from);
  for (std::size_t i = 0; i < count; ++i) state_ = (state_ ^ b[i]) * 0x100000001b3ull;
}

std::filesystem::path cache_folder() {
  namespace fs = std::filesystem;
  if (switched_off()) return {};
  if (fs::path const own = variable("SCREE_CACHE"); !own.empty()) return own;
  if (fs::path const xdg = variable("XDG_CACHE_HOME"); xdg.is_absolute()) return xdg / "scree";
  if (fs::path const home = variable("HOME"); home.is_absolute()) return home / ".cache" / "scree";
  return {};
}

std::optional<Library> read_cached(std::string const& key, std::vector<std::string>& notes) {
  std::filesystem::path const folder = cache_folder(), file = file_of(folder, key);
  std::error_code error;
  if (folder.empty() || !std::filesystem::exists(file, error)) return std::nullopt;
  try {
    return read_model(file);
  } catch (std::exception const&) {
    add_note(notes, file.string() + " is damaged and is made again");
    return std::nullopt;
  }
}

void keep_cached(std::string const& key, Library const& library, std::string const& what,
                 std::vector<std::string>& notes) {
  std::filesystem::path const folder = cache_folder();
  if (folder.empty()) {
    if (!switched_off()) add_note(notes, what + " are not kept: neither SCREE_CACHE nor HOME names a folder");
    return;
  }
  try {
    std::filesystem::create_directories(folder);
    write_model(file_of(folder, key), library, true);
  } catch (std::exception const&) {
    add_note(notes,
             what + " are not kept: " + folder.string() + " cannot be written; point SCREE_CACHE to a folder that can");
  }
}

}  // namespace scree
