// mesh_tree.cpp: see mesh_tree.h. Median splits along the longest axis of the triangles' centres.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "shapes/mesh_files.h"

namespace scree {
namespace {

class TreeBuilder {
 public:
  TreeBuilder(TriangleMesh const& mesh, std::vector<MeshNode>& node) : mesh_(mesh), node_(node) {
    for (auto const& t : mesh.triangle)
      centre_.push_back((mesh.vertex[t[0]] + mesh.vertex[t[1]] + mesh.vertex[t[2]]) / 3);
    order_.resize(mesh.triangle.size());
    std::iota(order_.begin(), order_.end(), 0);
    build(0, static_cast<int>(order_.size()));
  }
  std::vector<int> const& order() const { return order_; }

 private:
  int build(int first, int count) {
    int const self = static_cast<int>(node_.size());
    node_.push_back(bounds(first, count));
    if (count <= mesh_leaf_size) {
      node_[self].first = first;
      node_[self].count = count;
      return self;
    }
    int const axis = longest_axis(first, count);
    std::sort(order_.begin() + first, order_.begin() + first + count, [&](int a, int b) {
      return centre_[a][axis] != centre_[b][axis] ? centre_[a][axis] < centre_[b][axis] : a < b;
    });
    build(first, count / 2);
    int const right = build(first + count / 2, count - count / 2);
    node_[self].right = right;
    return self;
  }

  MeshNode bounds(int first, int count) const {
    MeshNode n;
    n.min = n.max = mesh_.vertex[mesh_.triangle[order_[first]][0]];
    for (int i = first; i < first + count; ++i)
      for (int v : mesh_.triangle[order_[i]])
        for (int k = 0; k < 3; ++k) {
          n.min[k] = std::min(n.min[k], mesh_.vertex[v][k]);
          n.max[k] = std::max(n.max[k], mesh_.vertex[v][k]);
        }
    return n;
  }

  int longest_axis(int first, int count) const {
    Vec3 low = centre_[order_[first]], high = low;
    for (int i = first; i < first + count; ++i)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], centre_[order_[i]][k]);
        high[k] = std::max(high[k], centre_[order_[i]][k]);
      }
    Vec3 const size = high - low;
    return size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  }

  TriangleMesh const& mesh_;
  std::vector<MeshNode>& node_;
  std::vector<Vec3> centre_;
  std::vector<int> order_;
};

std::uint64_t edge_key(int a, int b) {
  return std::uint64_t(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
}

// Unit normals of the faces (zero without area) and the sums of them on edges and at vertices.
struct PseudoNormals {
  std::vector<Vec3> face, vertex;
  std::unordered_map<std::uint64_t, Vec3> edge;

  PseudoNormals(TriangleMesh const& mesh, MeshBorder border) : vertex(mesh.vertex.size()) {
    sum(mesh);
    if (border == MeshBorder::open) clear_borders(mesh);
  }

  void clear_borders(TriangleMesh const& mesh) {
    std::unordered_map<std::uint64_t, int> uses;
    for (auto const& t : mesh.triangle)
      for (int k = 0; k < 3; ++k) ++uses[edge_key(t[k], t[(k + 1) % 3])];
    for (auto const& [key, n] : uses)
      if (n == 1) edge[key] = vertex[key >> 32] = vertex[key & 0xffffffff] = {};
  }

  void sum(TriangleMesh const& mesh) {
    for (auto const& t : mesh.triangle) {
      Vec3 const p[3] = {mesh.vertex[t[0]], mesh.vertex[t[1]], mesh.vertex[t[2]]};
      Vec3 const n = cross(p[1] - p[0], p[2] - p[0]);
      double const length = norm(n);
      face.push_back(length > 0 ? n / length : Vec3{});
      for (int k = 0; k < 3; ++k) {
        edge[edge_key(t[k], t[(k + 1) % 3])] += face.back();
        Vec3 const u = p[(k + 1) % 3] - p[k], v = p[(k + 2) % 3] - p[k];
        vertex[t[k]] += face.back() * std::atan2(norm(cross(u, v)), dot(u, v));
      }
    }
  }
};

void require_sound(TriangleMesh const& mesh) {
  if (mesh.triangle.empty()) throw std::invalid_argument("the mesh has no triangles");
  if (mesh.triangle.size() > 1u << 28) throw std::invalid_argument("the mesh has more than 2^28 triangles");
  for (auto const& t : mesh.triangle)
    for (int v : t)
      if (v < 0 || v >= static_cast<int>(mesh.vertex.size()))
        throw std::invalid_argument("a triangle names vertex " + std::to_string(v) + ", but there are " +
                                    std::to_string(mesh.vertex.size()));
  for (Vec3 const& v : mesh.vertex)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(v[k]) <= largest_coordinate)) throw std::invalid_argument("a coordinate is beyond 1e60");
}

}  // namespace

MeshTree::MeshTree(TriangleMesh mesh, MeshBorder border) : mesh_(std::move(mesh)) {
  require_sound(mesh_);
  TreeBuilder const tree(mesh_, node_);
  PseudoNormals const normals(mesh_, border);
  corner_.reserve(3 * mesh_.triangle.size());
  normal_.reserve(std::size_t(normals_per_triangle) * mesh_.triangle.size());
  for (int i : tree.order()) {
    auto const& t = mesh_.triangle[i];
    normal_.push_back(normals.face[i]);
    for (int k = 0; k < 3; ++k) {
      corner_.push_back(mesh_.vertex[t[k]]);
      normal_.push_back(normals.edge.at(edge_key(t[k], t[(k + 1) % 3])));
    }
    for (int v : t) normal_.push_back(normals.vertex[v]);
  }
}

}  // namespace scree
