// zero_set.cpp: marching tetrahedra on a sparse grid. Kuhn's subdivision: each cell is six tetrahedra around its main
// diagonal, the same in every cell, so that faces match. Doi and Koide (1991) describe the tetrahedral cases.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/zero_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

namespace scree {
namespace {

struct Index3 {
  int i, j, k;
};

class Grid {
 public:
  Grid(PhiBatch const& phi, ZeroSetOptions const& options)
      : phi_(phi), options_(options), cell_(2 * options.radius / options.cells) {
    // Two cells of margin, in blocks of 8; an offset that is no fraction of a cell keeps flat faces off grid planes.
    vertices_ = (options.cells + 4 + 7) / 8 * 8 + 1;
    double const half = 0.5 * cell_ * (vertices_ - 1);
    origin_ = Vec3{-half, -half, -half} + Vec3{0.1374, 0.2713, 0.4119} * cell_;
    value_.assign(std::size_t(vertices_) * vertices_ * vertices_, -1);
    fill();
  }

  int cells() const { return vertices_ - 1; }
  double cell() const { return cell_; }
  std::size_t id(Index3 v) const { return (std::size_t(v.k) * vertices_ + v.j) * vertices_ + v.i; }
  double value(Index3 v) const { return value_[id(v)]; }
  Vec3 position(Index3 v) const { return origin_ + Vec3{double(v.i), double(v.j), double(v.k)} * cell_; }

 private:
  // Blocks of 8, 4 and 2 cells whose centre value rules out a sign change are filled with one sign; the rest is
  // evaluated vertex by vertex.
  void fill() {
    std::vector<Index3> block, wanted;
    for (int k = 0; k < cells(); k += 8)
      for (int j = 0; j < cells(); j += 8)
        for (int i = 0; i < cells(); i += 8) block.push_back({i, j, k});
    for (int size = 8; size >= 2; size /= 2) block = split(block, size);
    std::vector<char> taken(value_.size(), 0);
    for (Index3 b : block)
      for_vertices(b, 1, [&](Index3 v) {
        if (!taken[id(v)]) wanted.push_back(v);
        taken[id(v)] = 1;
      });
    std::vector<double> const value = evaluate(wanted, 0);
    for (std::size_t n = 0; n < wanted.size(); ++n) value_[id(wanted[n])] = value[n];
  }

  std::vector<Index3> split(std::vector<Index3> const& block, int size) {
    std::vector<double> centre(block.size(), 0);
    double const reach =
        options_.lipschitz > 0 ? 0.5 * std::sqrt(3.0) * size * cell_ * std::max(options_.lipschitz, 1.0) : INFINITY;
    if (options_.lipschitz > 0) centre = evaluate(block, 0.5 * size);
    std::vector<Index3> kept;
    for (std::size_t n = 0; n < block.size(); ++n) {
      if (std::abs(centre[n]) > reach) {
        for_vertices(block[n], size, [&](Index3 v) { value_[id(v)] = centre[n]; });
        continue;
      }
      int const half = size / 2;
      for (int c = 0; c < 8; ++c)
        kept.push_back({block[n].i + (c & 1) * half, block[n].j + (c >> 1 & 1) * half, block[n].k + (c >> 2) * half});
    }
    return kept;
  }

  template <class Visit>
  void for_vertices(Index3 b, int size, Visit const& visit) {
    for (int k = b.k; k <= b.k + size; ++k)
      for (int j = b.j; j <= b.j + size; ++j)
        for (int i = b.i; i <= b.i + size; ++i) visit({i, j, k});
  }

  // min(phi, depth below the ball's surface) at grid vertices moved by `offset` cells along the diagonal: the solid cut
  // by the ball. The network is never asked outside.
  std::vector<double> evaluate(std::vector<Index3> const& at, double offset) const {
    std::vector<double> value(at.size());
    std::vector<Vec3> inside;
    std::vector<std::size_t> index;
    for (std::size_t n = 0; n < at.size(); ++n) {
      Vec3 const x = position(at[n]) + Vec3{1, 1, 1} * (offset * cell_);
      double const depth = options_.radius - norm(x);
      value[n] = depth;
      if (depth > 0) inside.push_back(x), index.push_back(n);
    }
    std::vector<double> phi(inside.size());
    if (!inside.empty()) phi_(inside, phi, {});
    for (std::size_t n = 0; n < index.size(); ++n) {
      if (!std::isfinite(phi[n])) throw std::runtime_error("phi is not finite inside its ball");
      value[index[n]] = std::min(phi[n], value[index[n]]);
    }
    return value;
  }

  PhiBatch const& phi_;
  ZeroSetOptions options_;
  double cell_;
  int vertices_;  // along an edge
  Vec3 origin_;
  std::vector<double> value_;
};

// Builds the mesh tetrahedron by tetrahedron; a vertex belongs to a grid edge and is made once.
class Mesher {
 public:
  explicit Mesher(Grid const& grid) : grid_(grid) {}

  TriangleMesh run() {
    for (int k = 0; k < grid_.cells(); ++k)
      for (int j = 0; j < grid_.cells(); ++j)
        for (int i = 0; i < grid_.cells(); ++i) add_cell({i, j, k});
    return std::move(mesh_);
  }

 private:
  void add_cell(Index3 c) {
    int inside = 0;
    for (int n = 0; n < 8; ++n) inside += grid_.value(corner(c, n)) > 0;
    if (inside == 0 || inside == 8) return;
    // The six orders in which the three steps from corner 0 to corner 7 can be taken.
    int constexpr path[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
    for (auto const& p : path) add_tetrahedron({corner(c, 0), corner(c, p[0]), corner(c, p[1]), corner(c, 7)});
  }
  static Index3 corner(Index3 c, int n) { return {c.i + (n & 1), c.j + (n >> 1 & 1), c.k + (n >> 2)}; }

  void add_tetrahedron(std::array<Index3, 4> const& t) {
    std::array<int, 4> in{}, out{};
    int ins = 0, outs = 0;
    for (int n = 0; n < 4; ++n) (grid_.value(t[n]) > 0 ? in[ins++] : out[outs++]) = n;
    if (ins == 0 || outs == 0) return;
    Vec3 towards_out;
    for (int n = 0; n < ins; ++n) towards_out -= grid_.position(t[in[n]]) / ins;
    for (int n = 0; n < outs; ++n) towards_out += grid_.position(t[out[n]]) / outs;
    if (ins == 2) {  // a quadrilateral around the two pairs
      std::array<int, 4> const v{crossing(t[in[0]], t[out[0]]), crossing(t[in[0]], t[out[1]]),
                                 crossing(t[in[1]], t[out[1]]), crossing(t[in[1]], t[out[0]])};
      add_triangle(v[0], v[1], v[2], towards_out);
      add_triangle(v[0], v[2], v[3], towards_out);
      return;
    }
    auto const& many = ins == 3 ? in : out;
    Index3 const lone = t[ins == 1 ? in[0] : out[0]];
    add_triangle(crossing(lone, t[many[0]]), crossing(lone, t[many[1]]), crossing(lone, t[many[2]]), towards_out);
  }

  void add_triangle(int a, int b, int c, Vec3 towards_out) {
    Vec3 const p = mesh_.vertex[a];
    if (dot(cross(mesh_.vertex[b] - p, mesh_.vertex[c] - p), towards_out) < 0) std::swap(b, c);
    mesh_.triangle.push_back({a, b, c});
  }

  int crossing(Index3 a, Index3 b) {
    std::uint64_t const p = grid_.id(a), q = grid_.id(b);
    auto const [at, fresh] =
        vertex_.try_emplace(std::min(p, q) << 32 | std::max(p, q), static_cast<int>(mesh_.vertex.size()));
    if (fresh) {
      double const u = grid_.value(a), v = grid_.value(b);
      // Off the grid vertices, where the crossings of many edges would coincide and triangles lose their side.
      double const s = std::clamp(u / (u - v), 0.05, 0.95);
      mesh_.vertex.push_back(grid_.position(a) * (1 - s) + grid_.position(b) * s);
    }
    return at->second;
  }

  Grid const& grid_;
  TriangleMesh mesh_;
  std::unordered_map<std::uint64_t, int> vertex_;
};

int count_components(TriangleMesh const& mesh) {
  std::vector<int> parent(mesh.vertex.size());
  std::iota(parent.begin(), parent.end(), 0);
  auto const root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (auto const& t : mesh.triangle) {
    parent[root(t[0])] = root(t[1]);
    parent[root(t[1])] = root(t[2]);
  }
  int components = 0;
  for (int v = 0; v < static_cast<int>(parent.size()); ++v) components += root(v) == v;
  return components;
}

// Halfway to the mean of the neighbours, `rounds` times: marching tetrahedra leave splinters that may fold over when
// their vertices are projected.
void smooth(PhiBatch const& phi, ZeroSet& set, int rounds) {
  std::size_t const n = set.mesh.vertex.size();
  std::vector<Vec3> sum(n), gradient(n);
  std::vector<int> count(n);
  for (int round = 0; round < rounds; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3{});
    std::fill(count.begin(), count.end(), 0);
    for (auto const& t : set.mesh.triangle)
      for (int k = 0; k < 3; ++k) {
        sum[t[k]] += set.mesh.vertex[t[(k + 1) % 3]];  // each neighbour once: every edge is met in both directions
        ++count[t[k]];
      }
    for (std::size_t i = 0; i < n; ++i) set.mesh.vertex[i] = set.mesh.vertex[i] * 0.5 + sum[i] * (0.5 / count[i]);
    project_to_surface(phi, set.mesh.vertex, gradient, set.cell, 1);
  }
}

// Vertices from `first` on onto phi = 0, normals from the gradient there.
void settle(PhiBatch const& phi, ZeroSet& set, int first, double reach, int steps) {
  int const n = static_cast<int>(set.mesh.vertex.size());
  std::vector<double> left(n - first);
  set.normal.resize(n);
  project_to_surface(phi, Span<Vec3>(set.mesh.vertex).subspan(first, n - first),
                     Span<Vec3>(set.normal).subspan(first, n - first), reach, steps, left);
  for (int i = first; i < n; ++i) {
    double const length = norm(set.normal[i]);
    set.normal[i] = length > 0 ? set.normal[i] * (-1 / length) : Vec3{};
    set.worst_phi = std::max(set.worst_phi, std::abs(left[i - first]));
  }
}

}  // namespace

ZeroSet find_zero_set(PhiBatch const& phi, ZeroSetOptions const& options) {
  if (!(options.radius > 0) || !std::isfinite(options.radius))
    throw std::invalid_argument("find_zero_set: radius must be positive");
  if (options.cells < 4 || options.cells > 1000) throw std::invalid_argument("find_zero_set: cells must be in 4..1000");
  Grid const grid(phi, options);
  ZeroSet set;
  set.mesh = Mesher(grid).run();
  if (set.mesh.triangle.empty())
    throw std::runtime_error("phi has no zero set in its ball: it has one sign everywhere");
  set.cell = grid.cell();
  set.components = count_components(set.mesh);
  set.euler_characteristic = static_cast<int>(set.mesh.vertex.size()) - static_cast<int>(set.mesh.triangle.size()) / 2;
  std::vector<Vec3> gradient(set.mesh.vertex.size());
  project_to_surface(phi, set.mesh.vertex, gradient, 1.5 * set.cell, 2);
  smooth(phi, set, 3);
  settle(phi, set, 0, set.cell, 4);
  return set;
}

namespace {

// Where a new vertex between a and b starts from: the middle, or, where the surface turns by more than a quarter of a
// right angle between them, the point of both tangent planes nearest to it. On a sharp edge that is the edge itself
// (Kobbelt et al. 2001, extended marching cubes).
Vec3 between(ZeroSet const& set, int a, int b) {
  Vec3 const p = set.mesh.vertex[a], q = set.mesh.vertex[b], n = set.normal[a], m = set.normal[b];
  Vec3 const middle = (p + q) * 0.5;
  double const c = dot(n, m), determinant = 1 - c * c;
  if (c > 0.92 || determinant < 0.01) return middle;
  double const u = dot(n, p - middle), v = dot(m, q - middle);  // heights of the planes over the middle
  Vec3 const step = n * ((u - c * v) / determinant) + m * ((v - c * u) / determinant);
  return norm(step) < norm(q - p) ? middle + step : middle;
}

}  // namespace

ZeroSet refine(PhiBatch const& phi, ZeroSet const& coarse) {
  ZeroSet fine = coarse;
  fine.mesh.triangle.clear();
  std::unordered_map<std::uint64_t, int> middle;
  auto const midpoint = [&](int a, int b) {
    std::uint64_t const key = std::uint64_t(std::min(a, b)) << 32 | std::uint64_t(std::max(a, b));
    auto const [at, fresh] = middle.try_emplace(key, static_cast<int>(fine.mesh.vertex.size()));
    if (fresh) fine.mesh.vertex.push_back(between(coarse, a, b));
    return at->second;
  };
  for (auto const& t : coarse.mesh.triangle) {
    int const a = midpoint(t[0], t[1]), b = midpoint(t[1], t[2]), c = midpoint(t[2], t[0]);
    fine.mesh.triangle.insert(fine.mesh.triangle.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
  }
  fine.cell = coarse.cell / 2;
  settle(phi, fine, static_cast<int>(coarse.mesh.vertex.size()), 0.5 * coarse.cell, 3);
  return fine;
}

MeshMass zero_set_mass(PhiBatch const& phi, ZeroSet const& zero_set) {
  // The first refinement recovers sharp edges, which marching cuts off; two levels on the same footing follow.
  ZeroSet const sharp = refine(phi, zero_set);
  MeshMass const coarse = mesh_mass(sharp.mesh), fine = mesh_mass(refine(phi, sharp).mesh);
  MeshMass mass;
  // Richardson: the error of an inscribed polyhedron is of second order, so a quarter is left after the refinement.
  mass.volume = (4 * fine.volume - coarse.volume) / 3;
  mass.area = (4 * fine.area - coarse.area) / 3;
  mass.centroid = (fine.centroid * 4 - coarse.centroid) / 3;
  for (int i = 0; i < 3; ++i) mass.inertia.row[i] = (fine.inertia.row[i] * 4 - coarse.inertia.row[i]) / 3;
  return mass;
}

}  // namespace scree
