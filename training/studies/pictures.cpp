// pictures.cpp: meshes that the plotting script draws.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/pictures.h"

#include <algorithm>
#include <stdexcept>

#include "shapes/mesh_files.h"

namespace scree {

std::string write_picture_mesh(StudyOptions const& options, std::string name, TriangleMesh const& mesh) {
  std::replace(name.begin(), name.end(), '/', '-');
  std::filesystem::create_directories(options.folder / "meshes");
  std::string const relative = "meshes/" + name + ".stl";
  write_mesh(options.folder / relative, mesh);
  return relative;
}

ZeroSet picture_surface(StudyOptions const& options, PhiBatch const& phi, double radius) {
  try {
    return find_zero_set(phi, {radius, options.quick ? 20 : 40, 0});
  } catch (std::runtime_error const&) {
    return {};  // a network that is barely trained may be empty
  }
}

}  // namespace scree
