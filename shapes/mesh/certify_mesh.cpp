// certify_mesh.cpp: see certify_mesh.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/certify_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shapes/normalise.h"

namespace scree {
namespace {

TriangleMesh centred(TriangleMesh mesh) {
  Vec3 const centroid = mesh_mass(mesh).centroid;
  for (Vec3& v : mesh.vertex) v -= centroid;
  return mesh;
}

}  // namespace

MeshTruth::MeshTruth(TriangleMesh mesh, Library const& library, Shape const& shape, int threads)
    : mesh_(std::move(mesh)), threads_(threads) {
  MeshDistance{mesh_};  // refuses what bounds no solid, before its centroid is asked for
  mesh_ = centred(std::move(mesh_));
  distance_ = std::make_shared<MeshDistance const>(mesh_);
  alignment_ = align_shape(surface_phi(library, shape, threads), mesh_);
}

CertifyTruth MeshTruth::truth() const {
  return truth_of(
      mesh_, [distance = distance_, threads = threads_](Span<const Vec3> x, Span<double> phi, Span<Vec3> gradient) {
        distance->evaluate(x, phi, gradient, threads);
      });
}

NormalComparison MeshTruth::compare_normals(PhiBatch const& phi, int points) const {
  return scree::compare_normals(phi, truth(), alignment_.frame, points);
}

void MeshTruth::certify(PhiBatch const& phi, Shape const& shape, int points, std::uint64_t seed,
                        Certificate& certificate) const {
  scree::certify(phi, truth(), alignment_.frame, points, seed, certificate);
  MeshMass const mass = mesh_mass(mesh_);
  double const scale = alignment_.frame.scale;
  certificate.volume_error = std::abs(shape.volume * std::pow(scale, 3) / mass.volume - 1);
  Vec3 moment;
  Mat3 axes;
  principal_axes(mass.inertia, moment, axes);
  certificate.inertia_error = 0;
  for (int k = 0; k < 3; ++k)
    certificate.inertia_error =
        std::max(certificate.inertia_error, std::abs(shape.inertia[k] * std::pow(scale, 5) / moment[k] - 1));
}

}  // namespace scree
