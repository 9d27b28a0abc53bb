// mesh_files.cpp: see mesh_files.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_files.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <unordered_map>

#include "shapes/obj_file.h"
#include "shapes/ply_file.h"
#include "shapes/stl_file.h"
#include "shapes/text_lines.h"
#include "shapes/whole_file.h"

namespace scree {
namespace {

struct PointHash {
  std::size_t operator()(Vec3 const& v) const {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) {
      double const plus_zero = v[i] + 0.0;  // -0 equals 0 and must hash alike
      std::uint64_t bits = 0;
      std::memcpy(&bits, &plus_zero, sizeof(bits));
      h = (h ^ bits) * 0x9e3779b97f4a7c15ull;
      h ^= h >> 29;
    }
    return h;
  }
};

}  // namespace

TriangleMesh weld(TriangleMesh const& soup) {
  TriangleMesh mesh;
  std::unordered_map<Vec3, int, PointHash> known;
  std::vector<int> index(soup.vertex.size());
  for (std::size_t i = 0; i < soup.vertex.size(); ++i) {
    auto const [at, fresh] = known.try_emplace(soup.vertex[i], static_cast<int>(mesh.vertex.size()));
    if (fresh) mesh.vertex.push_back(soup.vertex[i]);
    index[i] = at->second;
  }
  for (auto const& t : soup.triangle) {
    std::array<int, 3> const u{index[t[0]], index[t[1]], index[t[2]]};
    if (u[0] != u[1] && u[1] != u[2] && u[2] != u[0]) mesh.triangle.push_back(u);
  }
  return mesh;
}

void check_coordinates(std::filesystem::path const& file, TriangleMesh const& mesh) {
  for (Vec3 const& v : mesh.vertex)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(v[k]) <= largest_coordinate)) fail_file(file, "a coordinate is beyond 1e60");
}

TriangleMesh read_mesh(std::filesystem::path const& file) {
  std::string const extension = lower_extension(file);
  if (!is_mesh_file(file)) fail_file(file, "unknown mesh format; .stl, .obj and .ply are read");
  std::string const bytes = read_whole_file(file);
  TriangleMesh mesh;
  if (extension == ".stl") mesh = parse_stl(file, bytes);
  if (extension == ".obj") mesh = parse_obj(file, bytes);
  if (extension == ".ply") {
    PlyContent ply = parse_ply(file, bytes);
    mesh = {std::move(ply.vertex), std::move(ply.triangle)};
  }
  mesh = weld(mesh);
  check_coordinates(file, mesh);
  if (mesh.triangle.empty()) fail_file(file, "has no triangles");
  return mesh;
}

void write_mesh(std::filesystem::path const& file, TriangleMesh const& mesh) {
  std::string const extension = lower_extension(file);
  if (!is_mesh_file(file)) fail_file(file, "unknown mesh format; .stl, .obj and .ply are written");
  std::string const bytes = extension == ".stl"   ? stl_bytes(mesh)
                            : extension == ".obj" ? obj_text(mesh)
                                                  : ply_bytes(mesh.vertex, {}, mesh.triangle);
  replace_whole_file(file, bytes);
}

bool is_mesh_file(std::filesystem::path const& file) {
  std::string const extension = lower_extension(file);
  return extension == ".stl" || extension == ".obj" || extension == ".ply";
}

}  // namespace scree
