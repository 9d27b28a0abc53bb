// mesh_distance.cpp: exact signed distance to a closed triangle mesh by CGAL's AABB tree.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/mesh_distance.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shapes/mesh/cgal_mesh.h"
#include "shapes/mesh/mesh_check.h"

namespace scree {

using Primitive = CGAL::AABB_face_graph_triangle_primitive<cgal::Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<cgal::Kernel, Primitive>>;
using Side = CGAL::Side_of_triangle_mesh<cgal::Mesh, cgal::Kernel>;

struct MeshDistance::Data {
  cgal::Mesh mesh;
  Tree tree;
  std::unique_ptr<Side> side;
  std::vector<Vec3> normal;  // outward unit normal by face
  double on_surface = 0;     // below this distance the direction to the closest point is rounding noise [unit]
};

namespace {

void require_closed(TriangleMesh const& mesh) {
  MeshReport const report = check_mesh(mesh, false);
  if (!report.defects.empty()) throw std::invalid_argument(report.defects.front());
}

}  // namespace

MeshDistance::MeshDistance(TriangleMesh const& mesh) : data_(std::make_unique<Data>()) {
  require_closed(mesh);
  Data& d = *data_;
  d.mesh = cgal::to_cgal(mesh);
  double size = 0;
  for (Vec3 const& v : mesh.vertex) size = std::max(size, norm(v - mesh.vertex.front()));
  d.on_surface = 1e-10 * size;
  for (auto const& [a, b, c] : mesh.triangle) {
    Vec3 const n = cross(mesh.vertex[b] - mesh.vertex[a], mesh.vertex[c] - mesh.vertex[a]);
    d.normal.push_back(n / std::max(norm(n), 1e-300));
  }
  d.tree.insert(faces(d.mesh).first, faces(d.mesh).second, d.mesh);
  // Both are built lazily otherwise, which is not for several threads at once.
  d.tree.build();
  d.tree.accelerate_distance_queries();
  d.side = std::make_unique<Side>(d.tree);
}

MeshDistance::~MeshDistance() = default;
MeshDistance::MeshDistance(MeshDistance&&) noexcept = default;
MeshDistance& MeshDistance::operator=(MeshDistance&&) noexcept = default;

MeshDistance::Sample MeshDistance::at(Vec3 point) const {
  auto const [nearest, face] = data_->tree.closest_point_and_primitive(cgal::to_point(point));
  Sample sample;
  sample.closest = cgal::to_vec(nearest);
  Vec3 const away = point - sample.closest;
  double const distance = norm(away);
  if (distance <= data_->on_surface) {
    sample.gradient = -data_->normal[face];
    return sample;
  }
  bool const inside = (*data_->side)(cgal::to_point(point)) == CGAL::ON_BOUNDED_SIDE;
  sample.phi = inside ? distance : -distance;
  sample.gradient = away / sample.phi;
  return sample;
}

void MeshDistance::evaluate(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient, int threads) const {
  int const n = point.size();
  if (phi.size() != n || (!gradient.empty() && gradient.size() != n))
    throw std::invalid_argument("MeshDistance::evaluate: points, phi and gradient differ in count");
#pragma omp parallel for schedule(dynamic, 256) num_threads(std::max(threads, 1))
  for (int i = 0; i < n; ++i) {
    Sample const sample = at(point[i]);
    phi[i] = sample.phi;
    if (!gradient.empty()) gradient[i] = sample.gradient;
  }
}

}  // namespace scree
