// mesh_shape.cpp: see mesh_shape.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_shape.h"

#include <algorithm>
#include <stdexcept>

#include "shapes/mesh_files.h"
#include "shapes/mesh_normalise.h"
#include "shapes/mesh_report.h"

namespace scree {

void set_mesh(Library const& library, int index, Shape& shape) {
  shape.kind = ShapeKind::mesh;
  shape.data = index;
  shape.lipschitz = 1;
  MeshSdf const sdf = library.mesh.at(static_cast<std::size_t>(index))->sdf();
  shape.box = {sdf.node[0].min, sdf.node[0].max};
  shape.bounding_radius = 0;
  for (Vec3 const& v : sdf.corner) shape.bounding_radius = std::max(shape.bounding_radius, norm(v));
}

int add_mesh_shape(Library& library, std::string const& name, TriangleMesh const& mesh) {
  MeshReport const report = report_mesh(mesh);
  if (!report.defects.empty()) {
    std::string what = "the mesh does not bound one solid:";
    for (std::string const& defect : report.defects) what += " " + defect + ";";
    what.back() = '.';
    throw std::invalid_argument(what);
  }
  TriangleMesh const ours = normalised(weld(mesh));
  MeshMass const mass = mesh_mass(ours);
  Shape shape;
  shape.name = name;
  shape.volume = mass.volume;
  shape.area = mass.area;
  for (int i = 0; i < 3; ++i) shape.inertia[i] = mass.inertia.row[i][i];
  shape.certificate.components = 1;
  shape.certificate.source = name;
  library.mesh.push_back(std::make_shared<MeshTree const>(ours));
  set_mesh(library, static_cast<int>(library.mesh.size()) - 1, shape);
  library.shape.push_back(shape);
  return static_cast<int>(library.shape.size()) - 1;
}

}  // namespace scree
