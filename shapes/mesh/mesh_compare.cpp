// mesh_compare.cpp: see mesh_compare.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/mesh_compare.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh_samples.h"

namespace scree {
namespace {

// |distance| of the mesh's points from the surface of `other`.
std::vector<double> distances(TriangleMesh const& mesh, TriangleMesh const& other, int samples, int threads) {
  std::vector<Vec3> point = sample_mesh(mesh, samples).position;
  std::size_t const every = mesh.vertex.size() / static_cast<std::size_t>(samples) + 1;
  for (std::size_t i = 0; i < mesh.vertex.size(); i += every) point.push_back(mesh.vertex[i]);
  std::vector<double> phi(point.size());
  MeshDistance(other).evaluate(point, phi, {}, threads);
  for (double& x : phi) x = std::abs(x);
  return phi;
}

}  // namespace

MeshDifference compare_meshes(TriangleMesh const& mesh, TriangleMesh const& truth, int samples, int threads) {
  std::vector<double> const there = distances(mesh, truth, samples, threads);
  std::vector<double> const back = distances(truth, mesh, samples, threads);
  MeshDifference d;
  d.from_mesh = *std::max_element(there.begin(), there.end());
  d.from_truth = *std::max_element(back.begin(), back.end());
  d.hausdorff = std::max(d.from_mesh, d.from_truth);
  double sum = 0;
  for (double x : there) sum += x;
  for (double x : back) sum += x;
  d.mean = sum / static_cast<double>(there.size() + back.size());
  d.volume_error = mesh_mass(mesh).volume / mesh_mass(truth).volume - 1;
  return d;
}

}  // namespace scree
