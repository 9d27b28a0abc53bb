// node_placement.cpp: density from curvature, Lloyd's iteration, ridges, support points.
// Cells are made of the mesh's triangles, assigned by centroid; the last assignment cuts the triangles on cell borders.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/node_placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

#include "shapes/nearest_site.h"
#include "shapes/point_blocks.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

struct Triangles {
  std::vector<Vec3> centroid;
  std::vector<Vec3> area_vector;
  std::vector<Vec3> normal;  // unit; of the vertices where the triangle itself has no area
  std::vector<double> area;
  std::vector<double> density;  // wanted nodes per area, any unit
};

struct Sites {
  std::vector<Vec3> position;
  std::vector<Vec3> normal;
  std::vector<char> pinned;  // sits on a ridge or a support point: stays there
  double spacing = 0;

  int size() const { return static_cast<int>(position.size()); }
};

// Largest convex bending over the edges of each triangle, spread over one ring of neighbours.
std::vector<double> convex_curvature(ZeroSet const& set) {
  std::vector<double> at_vertex(set.mesh.vertex.size(), 0), of_triangle(set.mesh.triangle.size(), 0);
  for (std::size_t t = 0; t < set.mesh.triangle.size(); ++t) {
    auto const& v = set.mesh.triangle[t];
    double bend = 0;
    for (int k = 0; k < 3; ++k) {
      int const a = v[k], b = v[(k + 1) % 3];
      Vec3 const dx = set.mesh.vertex[a] - set.mesh.vertex[b], dn = set.normal[a] - set.normal[b];
      bend = std::max(bend, dot(dx, dn) > 0 ? norm(dn) / std::max(norm(dx), 0.1 * set.cell) : 0);
    }
    for (int i : v) at_vertex[i] = std::max(at_vertex[i], bend);
  }
  for (std::size_t t = 0; t < of_triangle.size(); ++t)
    for (int i : set.mesh.triangle[t]) of_triangle[t] += at_vertex[i] / 3;
  return of_triangle;
}

Triangles measure(ZeroSet const& set, PlacementOptions const& options) {
  std::vector<double> const curvature = convex_curvature(set);
  Triangles tri;
  for (std::size_t t = 0; t < set.mesh.triangle.size(); ++t) {
    auto const& v = set.mesh.triangle[t];
    Vec3 const p = set.mesh.vertex[v[0]], q = set.mesh.vertex[v[1]], r = set.mesh.vertex[v[2]];
    Vec3 const area = cross(q - p, r - p) * 0.5;
    double const size = norm(area);
    Vec3 const mean = set.normal[v[0]] + set.normal[v[1]] + set.normal[v[2]];
    tri.centroid.push_back((p + q + r) / 3);
    tri.area_vector.push_back(area);
    tri.area.push_back(size);
    tri.normal.push_back(size > 0 ? area / size : mean / std::max(norm(mean), 1e-300));
    tri.density.push_back(std::clamp(curvature[t], options.least_curvature, options.largest_curvature));
  }
  return tri;
}

// One site in every equal share of the wanted density along a space-filling order of the triangles.
Sites first_sites(Triangles const& tri, int count) {
  PointBlocks const blocks = make_point_blocks(tri.centroid, 4);
  double total = 0;
  for (std::size_t t = 0; t < tri.area.size(); ++t) total += tri.area[t] * tri.density[t];
  Sites sites;
  double sum = 0;
  for (int t : blocks.order) {
    sum += tri.area[t] * tri.density[t];
    while (sites.size() < count && sum * count > total * (sites.position.size() + 0.5)) {
      sites.position.push_back(tri.centroid[t]);
      sites.normal.push_back(tri.normal[t]);
    }
  }
  sites.pinned.assign(sites.position.size(), 0);
  sites.spacing = std::sqrt(std::accumulate(tri.area.begin(), tri.area.end(), 0.0) / count);
  return sites;
}

struct Cells {
  std::vector<int> of_triangle;
  std::vector<Vec3>
      centroid;  // weighted by density^2: then spacing follows density^(-1/2) (Du, Faber, Gunzburger 1999)
  std::vector<Vec3> mean_normal;  // unit
  std::vector<double> area;
  std::vector<double> bulge;  // mean height of the normals over the centroid: > 0 on ridges and corners [d]
};

Cells assign(Triangles const& tri, Sites const& sites) {
  int const n = sites.size();
  NearestSite const nearest(sites.position, sites.normal, sites.spacing);
  Cells cells;
  cells.of_triangle.resize(tri.area.size());
  cells.centroid.assign(n, {});
  cells.mean_normal.assign(n, {});
  cells.area.assign(n, 0);
  cells.bulge.assign(n, 0);
  std::vector<double> weight(n, 0);
  for (std::size_t t = 0; t < tri.area.size(); ++t) {
    int const c = cells.of_triangle[t] = nearest.find(tri.centroid[t], tri.normal[t]);
    double const w = tri.area[t] * tri.density[t] * tri.density[t];
    cells.centroid[c] += tri.centroid[t] * w;
    cells.mean_normal[c] += tri.area_vector[t];
    cells.area[c] += tri.area[t];
    cells.bulge[c] += dot(tri.area_vector[t], tri.centroid[t]);
    weight[c] += w;
  }
  for (int c = 0; c < n; ++c) {
    double const length = norm(cells.mean_normal[c]);
    cells.centroid[c] = weight[c] > 0 ? cells.centroid[c] / weight[c] : sites.position[c];
    if (cells.area[c] > 0)
      cells.bulge[c] = (cells.bulge[c] - dot(cells.mean_normal[c], cells.centroid[c])) / cells.area[c];
    cells.mean_normal[c] = length > 0 ? cells.mean_normal[c] / length : sites.normal[c];
  }
  return cells;
}

// Where a cell bends (a ridge, a corner), its node goes to the highest mesh vertex along the mean normal, less a
// penalty for leaving the centre; elsewhere to the centroid.
void move_to_centres(ZeroSet const& set, Cells const& cells, Sites& sites) {
  int const n = sites.size();
  double constexpr bends = 0.04;  // of the cell's radius; a sphere at 250 nodes has 0.03, a right-angled ridge 0.3
  std::vector<double> score(n, -INFINITY), radius(n);
  std::vector<char> ridge(n);
  for (int c = 0; c < n; ++c) {
    radius[c] = std::sqrt(cells.area[c] / 3.141592653589793);
    ridge[c] = !sites.pinned[c] && cells.area[c] > 0 && cells.bulge[c] > bends * radius[c];
    if (!sites.pinned[c] && !ridge[c]) sites.position[c] = cells.centroid[c];
    if (!sites.pinned[c]) sites.normal[c] = cells.mean_normal[c];
  }
  for (std::size_t t = 0; t < set.mesh.triangle.size(); ++t) {
    int const c = cells.of_triangle[t];
    if (!ridge[c]) continue;
    for (int v : set.mesh.triangle[t]) {
      Vec3 const away = set.mesh.vertex[v] - cells.centroid[c];
      double const height = dot(away, cells.mean_normal[c]);
      double const value = height - 0.25 / radius[c] * (norm2(away) - height * height);
      if (value > score[c]) score[c] = value, sites.position[c] = set.mesh.vertex[v];
    }
  }
}

// Two nodes on one ridge vertex leave one without a cell: it goes to the far corner of the cell with most to share.
void refill_empty(Triangles const& tri, Cells const& cells, Sites& sites) {
  int const n = sites.size();
  std::vector<int> empty, order(n), farthest(n, -1);
  for (int c = 0; c < n; ++c)
    if (cells.area[c] == 0 && !sites.pinned[c]) empty.push_back(c);
  if (empty.empty()) return;
  std::vector<double> share(n, 0), distance2(n, -1);
  for (std::size_t t = 0; t < tri.area.size(); ++t) {
    int const c = cells.of_triangle[t];
    double const d2 = norm2(tri.centroid[t] - sites.position[c]);
    share[c] += tri.area[t] * tri.density[t];
    if (d2 > distance2[c]) distance2[c] = d2, farthest[c] = static_cast<int>(t);
  }
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return share[a] > share[b]; });
  for (std::size_t e = 0; e < empty.size() && farthest[order[e]] >= 0; ++e) {
    sites.position[empty[e]] = tri.centroid[farthest[order[e]]];
    sites.normal[empty[e]] = tri.normal[farthest[order[e]]];
  }
}

// The nearest site to x that `allowed` admits, no further than `reach`; -1 if there is none.
template <class Allowed>
int nearest_allowed(Sites const& sites, Vec3 x, double reach, Allowed const& allowed) {
  int nearest = -1;
  double nearest2 = reach * reach;
  for (int c = 0; c < sites.size(); ++c)
    if (norm2(sites.position[c] - x) < nearest2 && allowed(c)) nearest = c, nearest2 = norm2(sites.position[c] - x);
  return nearest;
}

struct Ridge {
  std::vector<Vec3> point;   // along the mesh's sharp convex edges
  std::vector<Vec3> normal;  // bisector of the two sides
};

// Mesh edges whose triangles meet at more than 25 degrees, outwards, as points no further than `distance` apart.
Ridge find_ridges(ZeroSet const& set, Triangles const& tri, double distance) {
  double constexpr cosine = 0.906;
  std::unordered_map<std::uint64_t, int> first_triangle;
  Ridge ridge;
  for (std::size_t t = 0; t < tri.area.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      auto const& corner = set.mesh.triangle[t];
      std::uint64_t const a = corner[k], b = corner[(k + 1) % 3];
      auto const [at, fresh] = first_triangle.try_emplace(std::min(a, b) << 32 | std::max(a, b), static_cast<int>(t));
      if (fresh) continue;
      int const other = at->second;
      bool const sharp = dot(tri.normal[t], tri.normal[other]) < cosine && tri.area[t] > 0 && tri.area[other] > 0;
      if (!sharp || dot(tri.normal[t], tri.centroid[other] - tri.centroid[t]) > 0) continue;
      Vec3 const p = set.mesh.vertex[a], q = set.mesh.vertex[b], n = tri.normal[t] + tri.normal[other];
      int const pieces = 1 + static_cast<int>(norm(q - p) / distance);
      for (int i = 0; i < pieces && norm(n) > 1e-6; ++i) {
        ridge.point.push_back(p + (q - p) * ((i + 0.5) / pieces));
        ridge.normal.push_back(normalized(n));
      }
    }
  return ridge;
}

// The nearest free site moves to x and stays there; false if there is none.
bool pin_nearest(Sites& sites, Vec3 x, Vec3 normal) {
  int const site = nearest_allowed(sites, x, INFINITY, [&](int c) { return !sites.pinned[c]; });
  if (site < 0) return false;
  sites.position[site] = x;
  sites.normal[site] = normal;
  sites.pinned[site] = 1;
  return true;
}

// Nodes on sharp corners and along sharp edges, at least `distance` apart and nowhere much further. Without them two
// rows of nodes settle beside an edge with their cells meeting on it, and the edge itself is blind.
void seed_ridges(ZeroSet const& set, Triangles const& tri, double distance, Sites& sites) {
  std::vector<Vec3> taken;
  auto const crowded = [&](Vec3 x) {
    return std::any_of(taken.begin(), taken.end(), [&](Vec3 p) { return norm2(p - x) < distance * distance; });
  };
  for (int v : set.corner)
    if (!crowded(set.mesh.vertex[v]) && pin_nearest(sites, set.mesh.vertex[v], set.normal[v]))
      taken.push_back(set.mesh.vertex[v]);
  Ridge const ridge = find_ridges(set, tri, 0.5 * distance);
  for (int i : make_point_blocks(ridge.point, 2).order) {           // neighbours follow each other
    if (static_cast<int>(taken.size()) >= sites.size() / 3) break;  // the faces need nodes too
    if (!crowded(ridge.point[i]) && pin_nearest(sites, ridge.point[i], ridge.normal[i]))
      taken.push_back(ridge.point[i]);
  }
}

// A direction in which the surface reaches higher than the nodes.
struct Shortfall {
  double gap;
  Vec3 direction;
  Vec3 summit;  // the extreme point
};

// Shortfalls above `tolerance`, largest first; `essential` marks the sites whose loss would make a new one.
std::vector<Shortfall> find_shortfalls(PhiBatch const& phi, ZeroSet const& set, std::vector<Vec3> const& direction,
                                       double tolerance, Sites const& sites, std::vector<char>& essential) {
  std::vector<int> const top = extreme_points(set.mesh.vertex, direction);
  std::vector<int> const mine = extreme_points(sites.position, direction);
  std::vector<Vec3> start, climb_direction;
  std::vector<int> own;
  essential.assign(sites.position.size(), 0);
  for (std::size_t k = 0; k < direction.size(); ++k) {
    double const gap = dot(direction[k], set.mesh.vertex[top[k]] - sites.position[mine[k]]);
    essential[mine[k]] = 1;
    if (gap < 0.5 * tolerance) continue;  // the mesh itself may fall short of the surface by as much
    start.push_back(set.mesh.vertex[top[k]]), climb_direction.push_back(direction[k]), own.push_back(mine[k]);
  }
  std::vector<Vec3> const summit = climb(phi, start, climb_direction, 0.5 * set.cell, 10);
  std::vector<Shortfall> found;
  for (std::size_t i = 0; i < summit.size(); ++i) {
    double const gap = dot(climb_direction[i], summit[i] - sites.position[own[i]]);
    if (gap > tolerance) found.push_back({gap, climb_direction[i], summit[i]});
  }
  std::stable_sort(found.begin(), found.end(), [](auto const& a, auto const& b) { return a.gap > b.gap; });
  return found;
}

// A node on every extreme point that the nodes fall short of by more than the tolerance. With `insert` it is a new one,
// else the nearest one that is no extreme node itself moves there (Lloyd's iteration closes the hole). A node that is
// almost there moves in either case.
void cover_support(PhiBatch const& phi, ZeroSet const& set, PlacementOptions const& options, double tolerance,
                   bool insert, Sites& sites) {
  std::vector<char> essential;
  std::vector<Vec3> added;
  for (Shortfall const& s :
       find_shortfalls(phi, set, quasi_uniform_directions(options.directions), tolerance, sites, essential)) {
    double gap = s.gap;
    for (Vec3 p : added) gap = std::min(gap, dot(s.direction, s.summit - p));
    if (gap < tolerance) continue;
    int site = nearest_allowed(sites, s.summit, 0.15 * sites.spacing, [&](int c) { return !sites.pinned[c]; });
    if (site < 0 && !insert)
      site = nearest_allowed(sites, s.summit, INFINITY, [&](int c) { return !sites.pinned[c] && !essential[c]; });
    if (site < 0) {
      site = sites.size();
      sites.position.emplace_back(), sites.normal.emplace_back(), sites.pinned.emplace_back();
      essential.push_back(1);
    }
    sites.position[site] = s.summit;
    sites.normal[site] = s.direction;
    sites.pinned[site] = 1;
    added.push_back(s.summit);
  }
}

// Gives the triangle's area to the sites of its pieces: cut in four while its corners belong to different sites.
struct AreaSharing {
  NearestSite nearest;
  std::vector<Vec3> sum;  // of each site

  void share(std::array<Vec3, 3> const& p, Vec3 normal, Vec3 area, int cuts) {
    if (cuts == 0) {
      sum[nearest.find((p[0] + p[1] + p[2]) / 3, normal)] += area;
      return;
    }
    std::array<Vec3, 3> const m{(p[1] + p[2]) * 0.5, (p[2] + p[0]) * 0.5, (p[0] + p[1]) * 0.5};
    share({p[0], m[2], m[1]}, normal, area / 4, cuts - 1);
    share({m[2], p[1], m[0]}, normal, area / 4, cuts - 1);
    share({m[1], m[0], p[2]}, normal, area / 4, cuts - 1);
    share(m, normal, area / 4, cuts - 1);
  }
};

// Area vectors of the cells. Triangles on cell borders are cut, twice where the cells are small.
std::vector<Vec3> cell_area_vectors(ZeroSet const& set, Triangles const& tri, PlacementOptions const& options,
                                    Sites const& sites) {
  AreaSharing sharing{NearestSite(sites.position, sites.normal, sites.spacing),
                      std::vector<Vec3>(sites.position.size())};
  std::vector<int> at_vertex(set.mesh.vertex.size());
  for (std::size_t v = 0; v < at_vertex.size(); ++v)
    at_vertex[v] = sharing.nearest.find(set.mesh.vertex[v], set.normal[v]);
  for (std::size_t t = 0; t < tri.area.size(); ++t) {
    auto const& v = set.mesh.triangle[t];
    bool const whole = at_vertex[v[0]] == at_vertex[v[1]] && at_vertex[v[1]] == at_vertex[v[2]];
    if (whole) {
      sharing.sum[at_vertex[v[0]]] += tri.area_vector[t];
      continue;
    }
    int const cuts = tri.density[t] > 0.5 * options.largest_curvature ? 2 : 1;
    sharing.share({set.mesh.vertex[v[0]], set.mesh.vertex[v[1]], set.mesh.vertex[v[2]]}, tri.normal[t],
                  tri.area_vector[t], cuts);
  }
  return sharing.sum;
}

}  // namespace

PlacedNodes place_nodes(PhiBatch const& phi, ZeroSet const& fine, PlacementOptions const& options) {
  if (options.count < 4) throw std::invalid_argument("place_nodes: at least 4 nodes are needed");
  Triangles const tri = measure(fine, options);
  Sites sites = first_sites(tri, options.count);
  // A sphere's nodes cannot do better than 0.38 spacing^2 (d = 1): below that only corners would be worth a node.
  double const tolerance = std::max(options.gap_tolerance, 0.65 * sites.spacing * sites.spacing);
  for (int round = 0; round < options.rounds; ++round) {
    Cells const cells = assign(tri, sites);
    move_to_centres(fine, cells, sites);
    refill_empty(tri, cells, sites);
    bool const last = round + 1 == options.rounds;
    if (round != 1 && !last) continue;
    std::vector<Vec3> gradient(sites.position.size());
    project_to_surface(phi, sites.position, gradient, sites.spacing, 3);
    if (!last) seed_ridges(fine, tri, 0.75 * std::min(options.ridge_spacing, 0.5 * sites.spacing), sites);
    cover_support(phi, fine, options, tolerance, last, sites);
  }
  std::vector<Vec3> area = cell_area_vectors(fine, tri, options, sites);
  // A pinned site that came out without a cell (a corner between close neighbours) shares its neighbour's.
  for (int c = 0; c < sites.size(); ++c) {
    if (!sites.pinned[c] || norm2(area[c]) > 0) continue;
    int const heir = nearest_allowed(sites, sites.position[c], INFINITY, [&](int k) { return norm2(area[k]) > 0; });
    area[c] = area[heir] = area[heir] / 2;
  }
  PlacedNodes nodes;
  for (std::size_t c = 0; c < area.size(); ++c) {
    if (!(norm2(area[c]) > 0)) continue;
    nodes.position.push_back(sites.position[c]);
    nodes.area_vector.push_back(area[c]);
  }
  return nodes;
}

}  // namespace scree
