// scree_surfaces.cpp: `scree export --stl`: grains, and on demand walls, of one frame as meshes in world coordinates.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "core/case.h"
#include "core/results.h"
#include "core/surface_export.h"
#include "shapes/mesh_files.h"
#include "tools/scree_commands.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

void check_free(fs::path const& file, bool force) {
  if (fs::exists(file) && !force) throw InputError({file.string() + " exists; choose another --output or add --force"});
}

}  // namespace

int export_surfaces(ExportArguments const& a) {
  ResultsReader const reader(a.results, a.recover);
  Frame const frame = reader.frame(a.frame);
  fs::path const beside = a.results.parent_path();
  fs::path const target = !a.folder.empty() ? a.folder : beside / (a.per_grain ? "grains" : "grains." + a.format);
  std::vector<TriangleMesh> walls;
  if (a.walls) walls = wall_meshes(reader.header(), frame);
  std::erase_if(walls, [](TriangleMesh const& m) { return m.triangle.empty(); });
  std::vector<fs::path> file;
  if (a.per_grain) {
    for (std::size_t i = 0; i < reader.header().shape.size(); ++i)
      if (frame.is_active(i)) file.push_back(target / fmt::format("grain_{:06}.{}", i, a.format));
    for (std::size_t w = 0; w < walls.size(); ++w) file.push_back(target / fmt::format("wall_{:03}.{}", w, a.format));
  } else {
    file.push_back(target);
    if (target.extension() != "." + a.format)
      throw InputError(
          {fmt::format("{}: --output must end in .{}, or name another --format", target.string(), a.format)});
  }
  for (fs::path const& f : file) check_free(f, a.force);
  std::vector<TriangleMesh> meshes = grain_meshes(reader.header(), frame, a.triangles);
  std::size_t const grains = meshes.size();
  meshes.insert(meshes.end(), walls.begin(), walls.end());
  if (a.per_grain)
    fs::create_directories(target);
  else
    meshes = {joined(meshes)};
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < file.size(); ++i) {
    write_mesh(file[i], meshes[i]);
    triangles += meshes[i].triangle.size();
  }
  fmt::print("surfaces  {}: t = {:.4g} s, {} grains, {} walls, {} triangles, world coordinates [m]\n", target.string(),
             frame.time, grains, walls.size(), triangles);
  return exit_ok;
}

}  // namespace scree
