// mesh_normalise.cpp: move a closed mesh to volume pi/6, centroid at the origin and principal axes.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/mesh_normalise.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree {

Normalisation normalisation_of(TriangleMesh const& mesh) {
  MeshMass const mass = mesh_mass(mesh);
  if (!(mass.volume > 0))
    throw std::invalid_argument("the mesh has volume " + std::to_string(mass.volume) + ": open or inside out");
  Eigen::Matrix3d inertia;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) inertia(i, j) = mass.inertia.row[i][j];
  // Ascending moments: the least belongs to the longest axis.
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvectors();
  // Signs are free; fixed here so that the same mesh always gives the same frame.
  for (int k = 0; k < 2; ++k) {
    int largest = 0;
    axes.col(k).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, k) < 0) axes.col(k) *= -1;
  }
  axes.col(2) = axes.col(0).cross(axes.col(1));
  Normalisation result;
  result.centroid = mass.centroid;
  result.scale = std::cbrt(std::numbers::pi / 6 / mass.volume);
  for (int k = 0; k < 3; ++k) result.rotation.row[k] = {axes(0, k), axes(1, k), axes(2, k)};
  return result;
}

TriangleMesh transformed(TriangleMesh const& mesh, Normalisation const& normalisation) {
  TriangleMesh result = mesh;
  for (Vec3& v : result.vertex) v = normalisation(v);
  return result;
}

TriangleMesh normalised(TriangleMesh const& mesh) { return transformed(mesh, normalisation_of(mesh)); }

}  // namespace scree
