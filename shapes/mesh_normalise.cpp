// mesh_normalise.cpp: move a closed mesh to volume pi/6, centroid at the origin and principal axes.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_normalise.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "shapes/normalise.h"

namespace scree {

Normalisation normalisation_of(TriangleMesh const& mesh) {
  MeshMass const mass = mesh_mass(mesh);
  if (!(mass.volume > 0))
    throw std::invalid_argument("the mesh has volume " + std::to_string(mass.volume) + ": open or inside out");
  Normalisation result;
  result.centroid = mass.centroid;
  result.scale = std::cbrt(std::numbers::pi / 6 / mass.volume);
  Vec3 moment;
  principal_axes(mass.inertia, moment, result.rotation);  // ascending: the least belongs to the longest axis
  return result;
}

TriangleMesh transformed(TriangleMesh const& mesh, Normalisation const& normalisation) {
  TriangleMesh result = mesh;
  for (Vec3& v : result.vertex) v = normalisation(v);
  return result;
}

TriangleMesh normalised(TriangleMesh const& mesh) { return transformed(mesh, normalisation_of(mesh)); }

}  // namespace scree
