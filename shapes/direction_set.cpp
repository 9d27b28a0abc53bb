// direction_set.cpp: see direction_set.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/direction_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/node_storage.h"
#include "shapes/point_blocks.h"
#include "shapes/support_points.h"

namespace scree {
namespace {

int constexpr lloyd_rounds = 8;  // evens out the lattice's poles; more changes solid angles by less than a per cent

struct Face {
  std::array<int, 3> v;  // counter-clockwise seen from outside
  Vec3 normal;           // unit: the face's circumcentre on the sphere
  double height;
};

Face make_face(std::vector<Vec3> const& point, int a, int b, int c) {
  Vec3 const n = normalized(cross(point[b] - point[a], point[c] - point[a]));
  return {{a, b, c}, n, dot(n, point[a])};
}

// Convex hull of points of the unit sphere, one point at a time: the faces it sees give way to a fan over their rim.
std::vector<Face> convex_hull(std::vector<Vec3> const& point) {
  int const n = static_cast<int>(point.size());
  int const start[4] = {0, n / 3, 2 * n / 3, n - 1};
  std::vector<Face> face;
  Vec3 const inside = (point[start[0]] + point[start[1]] + point[start[2]] + point[start[3]]) / 4;
  for (int skip = 0; skip < 4; ++skip) {
    int const a = start[(skip + 1) % 4], b = start[(skip + 2) % 4], c = start[(skip + 3) % 4];
    Face const f = make_face(point, a, b, c);
    face.push_back(dot(f.normal, inside) < f.height ? f : make_face(point, a, c, b));
  }
  std::vector<std::array<int, 2>> edge;
  for (int p = 0; p < n; ++p) {
    if (std::find(start, start + 4, p) != start + 4) continue;
    edge.clear();
    std::size_t kept = 0;
    for (Face const& f : face) {
      if (dot(f.normal, point[p]) > f.height)
        for (int k = 0; k < 3; ++k) edge.push_back({f.v[k], f.v[(k + 1) % 3]});
      else
        face[kept++] = f;
    }
    face.resize(kept);
    for (auto const& e : edge)
      if (std::find(edge.begin(), edge.end(), std::array{e[1], e[0]}) == edge.end())
        face.push_back(make_face(point, e[0], e[1], p));
  }
  if (static_cast<int>(face.size()) != 2 * n - 4) throw std::logic_error("convex_hull: the triangulation is broken");
  return face;
}

// Neighbours of each point in order, and the faces between them: face_of[i] holds neighbour[i] and the next one.
struct Rings {
  std::vector<int> first, neighbour, face_of;
};

Rings rings_of(std::vector<Face> const& face, int n) {
  Rings rings;
  std::vector<std::vector<std::array<int, 3>>> around(n);  // (neighbour, the next one, face)
  for (std::size_t f = 0; f < face.size(); ++f)
    for (int k = 0; k < 3; ++k)
      around[face[f].v[k]].push_back({face[f].v[(k + 1) % 3], face[f].v[(k + 2) % 3], static_cast<int>(f)});
  rings.first.push_back(0);
  for (auto const& faces : around) {
    auto at = *std::min_element(faces.begin(), faces.end());
    for (std::size_t k = 0; k < faces.size(); ++k) {
      rings.neighbour.push_back(at[0]);
      rings.face_of.push_back(at[2]);
      int const next = at[1];
      at = *std::find_if(faces.begin(), faces.end(), [&](auto const& f) { return f[0] == next; });
    }
    rings.first.push_back(static_cast<int>(rings.neighbour.size()));
  }
  return rings;
}

// Solid angle of a spherical triangle (Van Oosterom and Strackee 1983).
double solid_angle(Vec3 a, Vec3 b, Vec3 c) {
  return 2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

// Size and centroid of each Voronoi cell: its corners are the faces' circumcentres.
void measure_cells(std::vector<Vec3> const& point, std::vector<Face> const& face, Rings const& rings,
                   std::vector<double>& size, std::vector<Vec3>& centroid) {
  for (std::size_t p = 0; p < point.size(); ++p) {
    size[p] = 0;
    Vec3 sum;
    Vec3 before = face[rings.face_of[rings.first[p + 1] - 1]].normal;
    for (int i = rings.first[p]; i < rings.first[p + 1]; ++i) {
      Vec3 const corner = face[rings.face_of[i]].normal;
      double const part = solid_angle(point[p], before, corner);
      size[p] += part;
      sum += (point[p] + before + corner) * part;
      before = corner;
    }
    centroid[p] = normalized(sum);
  }
}

// Blocks of nodes_per_block, and quadruples within, so that every core_every-th direction comes from another place.
std::vector<Vec3> in_blocks(std::vector<Vec3> const& point) {
  std::vector<Vec3> sorted;
  PointBlocks const blocks = make_point_blocks(point, nodes_per_block);
  for (std::size_t b = 0; b + 1 < blocks.first.size(); ++b) {
    std::vector<Vec3> member;
    for (int i = blocks.first[b]; i < blocks.first[b + 1]; ++i) member.push_back(point[blocks.order[i]]);
    for (int i : make_point_blocks(member, core_every).order) sorted.push_back(member[i]);
  }
  return sorted;
}

void append_axes(DirectionSet& set, int every) {
  int const span = nodes_per_block * every;
  for (int begin = 0; begin < set.count(); begin += span) {
    Vec3 sum;
    for (int i = begin; i < std::min(begin + span, set.count()); i += every) sum += set.direction[i];
    set.block_axis.push_back(normalized(sum));
  }
}

}  // namespace

DirectionSet make_direction_set(int count) {
  if (count < 16 || count > 20000)
    throw std::invalid_argument("make_direction_set: " + std::to_string(count) + " directions, allowed are 16..20000");
  DirectionSet set;
  set.direction = quasi_uniform_directions(count, 0);
  set.solid_angle.resize(count);
  std::vector<Vec3> centroid(count);
  for (int round = 0; round < lloyd_rounds; ++round) {
    std::vector<Face> const face = convex_hull(set.direction);
    measure_cells(set.direction, face, rings_of(face, count), set.solid_angle, centroid);
    std::swap(set.direction, centroid);
  }
  set.direction = in_blocks(set.direction);
  std::vector<Face> const face = convex_hull(set.direction);
  Rings rings = rings_of(face, count);
  measure_cells(set.direction, face, rings, set.solid_angle, centroid);
  set.ring_first = std::move(rings.first);
  set.neighbour = std::move(rings.neighbour);
  append_axes(set, 1);
  set.surface_blocks = static_cast<int>(set.block_axis.size());
  append_axes(set, core_every);
  set.core_blocks = static_cast<int>(set.block_axis.size()) - set.surface_blocks;
  return set;
}

}  // namespace scree
