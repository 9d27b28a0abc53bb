// alpha_shape.cpp: see alpha_shape.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/mesh/alpha_shape.h"

#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "shapes/mesh/cgal_mesh.h"
#include "shapes/mesh/mesh_check.h"

namespace scree {
namespace {

// Vertices know the index of their point, cells get a number.
using VertexBase =
    CGAL::Alpha_shape_vertex_base_3<cgal::Kernel, CGAL::Triangulation_vertex_base_with_info_3<int, cgal::Kernel>>;
using CellBase =
    CGAL::Alpha_shape_cell_base_3<cgal::Kernel, CGAL::Triangulation_cell_base_with_info_3<int, cgal::Kernel>>;
using Structure = CGAL::Triangulation_data_structure_3<VertexBase, CellBase>;
using Delaunay = CGAL::Delaunay_triangulation_3<cgal::Kernel, Structure>;
using Complex = CGAL::Alpha_shape_3<Delaunay>;
using Cell = Complex::Cell_handle;

double constexpr growth = 1.05;  // of alpha while the surface is not manifold

// What a ball of radius sqrt(alpha) cannot reach from infinity.
class Solid {
 public:
  Solid(Complex const& complex, double alpha) : complex_(complex), outside_(complex.number_of_cells(), 0) {
    flood(outside_, complex.infinite_cell(), [&](Cell c, int i) {
      Cell const next = c->neighbor(i);
      return complex.is_infinite(next) || (complex.classify(next, alpha) == Complex::EXTERIOR &&
                                           complex.classify(Complex::Facet(c, i), alpha) == Complex::EXTERIOR);
    });
  }

  int parts() const {
    std::vector<char> seen(outside_.size(), 0);
    int parts = 0;
    for_each_cell([&](Cell c) {
      if (seen[c->info()]) return;
      ++parts;
      flood(seen, c, [&](Cell at, int i) { return !outside_[at->neighbor(i)->info()]; });
    });
    return parts;
  }

  int points_outside(std::size_t points) const {
    std::vector<char> inside(points, 0);
    for_each_cell([&](Cell c) {
      for (int i = 0; i < 4; ++i) inside[c->vertex(i)->info()] = 1;
    });
    auto const covered = std::count(inside.begin(), inside.end(), 1);
    return static_cast<int>(complex_.number_of_vertices()) - static_cast<int>(covered);
  }

  // Facets between solid and outside, in the order of the points.
  TriangleMesh boundary(std::vector<Vec3> const& point) const {
    std::vector<std::array<int, 3>> facet;
    for_each_cell([&](Cell c) {
      for (int i = 0; i < 4; ++i)
        if (outside_[c->neighbor(i)->info()]) facet.push_back(outward(c, i, point));
    });
    std::sort(facet.begin(), facet.end());
    TriangleMesh mesh;
    std::vector<int> index(point.size(), -1);
    for (auto const& t : facet)
      for (int v : t) index[v] = 0;
    for (std::size_t i = 0; i < point.size(); ++i) {
      if (index[i] < 0) continue;
      index[i] = static_cast<int>(mesh.vertex.size());
      mesh.vertex.push_back(point[i]);
    }
    for (auto const& t : facet) mesh.triangle.push_back({index[t[0]], index[t[1]], index[t[2]]});
    return mesh;
  }

 private:
  // The facet of the solid cell c opposite its vertex i, counter-clockwise from outside, smallest index first.
  static std::array<int, 3> outward(Cell c, int i, std::vector<Vec3> const& point) {
    auto const corner = [&](int k) { return c->vertex((i + k) & 3)->info(); };
    std::array<int, 3> t{corner(1), corner(2), corner(3)};
    Vec3 const p = point[t[0]];
    if (dot(cross(point[t[1]] - p, point[t[2]] - p), point[corner(0)] - p) > 0) std::swap(t[1], t[2]);
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  }

  template <class Visit>
  void for_each_cell(Visit const& visit) const {  // of the solid
    for (auto c = complex_.finite_cells_begin(); c != complex_.finite_cells_end(); ++c)
      if (!outside_[c->info()]) visit(Cell(c));
  }

  template <class Passes>
  static void flood(std::vector<char>& reached, Cell start, Passes const& passes) {
    std::vector<Cell> front{start};
    reached[start->info()] = 1;
    while (!front.empty()) {
      Cell const c = front.back();
      front.pop_back();
      for (int i = 0; i < 4; ++i) {
        Cell const next = c->neighbor(i);
        if (reached[next->info()] || !passes(c, i)) continue;
        reached[next->info()] = 1;
        front.push_back(next);
      }
    }
  }

  Complex const& complex_;
  std::vector<char> outside_;  // by number of the cell
};

bool is_manifold(TriangleMesh const& mesh) {
  if (!check_mesh(mesh, false).defects.empty()) return false;
  try {
    cgal::to_cgal(mesh);  // refuses surfaces that touch themselves in a point, too
  } catch (std::invalid_argument const&) {
    return false;
  }
  return true;
}

// Index into the sorted alphas of the smallest that makes one part without points outside: the solid grows with alpha,
// and at the last one it is the hull.
int smallest_solid(Complex const& complex, std::size_t points) {
  int low = 0, high = static_cast<int>(complex.number_of_alphas());  // from 1
  while (high - low > 1) {
    int const middle = (low + high) / 2;
    Solid const solid(complex, complex.get_nth_alpha(middle));
    (solid.points_outside(points) == 0 && solid.parts() == 1 ? high : low) = middle;
  }
  return high;
}

// To six digits: CGAL's last ones follow memory addresses, and the user may type it.
double round_up(double alpha) {
  double const unit = std::pow(10, std::floor(std::log10(alpha)) - 5);
  return std::ceil(alpha / unit) * unit;
}

}  // namespace

AlphaShape alpha_shape(std::vector<Vec3> const& point, double alpha) {
  std::vector<std::pair<cgal::Point, int>> numbered;
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (!is_finite(point[i])) throw std::invalid_argument("alpha shape: point " + std::to_string(i) + " is not finite");
    numbered.emplace_back(cgal::to_point(point[i]), static_cast<int>(i));
  }
  Delaunay delaunay(numbered.begin(), numbered.end());
  if (delaunay.dimension() < 3)
    throw std::invalid_argument("alpha shape: needs at least four points that are not in one plane");
  Complex complex(delaunay, 0, Complex::GENERAL);
  int cells = 0;
  for (auto c = complex.all_cells_begin(); c != complex.all_cells_end(); ++c) c->info() = cells++;

  AlphaShape result;
  result.smallest = round_up(complex.get_nth_alpha(smallest_solid(complex, point.size())));
  double const last = complex.get_nth_alpha(static_cast<int>(complex.number_of_alphas()));
  result.alpha = alpha > 0 ? alpha : result.smallest;
  for (;; result.alpha = std::min(result.alpha * growth, last)) {
    Solid const solid(complex, result.alpha);
    result.mesh = solid.boundary(point);
    if (alpha <= 0 && result.alpha < last && !is_manifold(result.mesh)) continue;
    result.parts = solid.parts();
    result.points_outside = solid.points_outside(point.size());
    return result;
  }
}

}  // namespace scree
