// wall_surface.cpp: see wall_surface.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/wall_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/results_walls.h"
#include "shapes/terrain_file.h"

namespace scree {
namespace {

double constexpr pi = std::numbers::pi;
int constexpr round_segments = 16;  // of a half circle in a profile

struct ProfilePoint {
  double r, z;
};

// Body of revolution about z. The free space is to the right of the profile, seen with r to the right and z up.
TriangleMesh revolved(std::vector<ProfilePoint> const& profile) {
  TriangleMesh mesh;
  std::vector<int> first;  // of each profile point's ring; a point on the axis is one vertex
  for (ProfilePoint const& p : profile) {
    first.push_back(static_cast<int>(mesh.vertex.size()));
    if (p.r > 0)
      for (Vec3 const& v : circle(p.r)) mesh.vertex.push_back({v.x, v.y, p.z});
    else
      mesh.vertex.push_back({0, 0, p.z});
  }
  for (std::size_t k = 0; k + 1 < profile.size(); ++k)
    for (int i = 0; i < circle_segments; ++i) {
      int const next = (i + 1) % circle_segments;
      bool const low = profile[k].r > 0, high = profile[k + 1].r > 0;
      int const a = first[k] + (low ? i : 0), b = first[k] + (low ? next : 0);
      int const c = first[k + 1] + (high ? next : 0), d = first[k + 1] + (high ? i : 0);
      if (low) mesh.triangle.push_back({a, b, c});
      if (high) mesh.triangle.push_back({a, c, d});
    }
  return mesh;
}

// Points of an arc about (r, z), both ends included; never beyond the axis.
void add_arc(std::vector<ProfilePoint>& out, double r, double z, double radius, double from, double to) {
  int const n = std::max(1, static_cast<int>(std::ceil(round_segments * std::fabs(to - from) / pi)));
  for (int i = 0; i <= n; ++i) {
    double const angle = from + (to - from) * i / n;
    double const reach = r + radius * std::cos(angle);
    out.push_back({reach > 1e-9 * radius ? reach : 0, z + radius * std::sin(angle)});
  }
}

// Up the outside, round the upper rim, down the inside and round the lower rim.
TriangleMesh funnel_surface(AnalyticSdf const& f) {
  double const low = f.half_size.x, high = f.half_size.y, h = f.half_size.z;
  double const outward = std::atan2(-(high - low), 2 * h);  // direction of the outer normal in the profile
  std::vector<ProfilePoint> profile;
  add_arc(profile, low, -h, f.half_wall, outward - pi, outward);
  add_arc(profile, high, h, f.half_wall, outward, outward + pi);
  profile.push_back(profile.front());
  return revolved(profile);
}

TriangleMesh box_surface(Vec3 h) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertex.push_back({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
  mesh.triangle = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// Convex polygon cut by the half space normal . (x - point) >= 0.
std::vector<Vec3> clip(std::vector<Vec3> const& polygon, Vec3 point, Vec3 normal) {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    Vec3 const a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    double const da = dot(a - point, normal), db = dot(b - point, normal);
    if (da >= 0) out.push_back(a);
    if ((da >= 0) != (db >= 0)) out.push_back(a + (b - a) * (da / (da - db)));
  }
  return out;
}

// Two unit vectors that make a right-handed frame with the unit vector n.
void span_plane(Vec3 n, Vec3& u, Vec3& v) {
  Vec3 const least = std::abs(n.x) <= std::abs(n.y) && std::abs(n.x) <= std::abs(n.z) ? Vec3{1, 0, 0}
                     : std::abs(n.y) <= std::abs(n.z)                                 ? Vec3{0, 1, 0}
                                                                                      : Vec3{0, 0, 1};
  u = normalized(cross(n, least));
  v = cross(n, u);
}

}  // namespace

std::vector<Vec3> circle(double radius) {
  std::vector<Vec3> out;
  for (int i = 0; i < circle_segments; ++i) {
    double const angle = 2 * pi * i / circle_segments;
    out.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return out;
}

TriangleMesh fan(std::vector<Vec3> const& ring) {
  TriangleMesh mesh{ring, {}};
  for (int i = 1; i + 1 < static_cast<int>(ring.size()); ++i) mesh.triangle.push_back({0, i, i + 1});
  return mesh;
}

std::vector<Vec3> plane_in_box(Vec3 point, Vec3 normal, Box const& box) {
  Vec3 const n = normalized(normal);
  Vec3 u, v;
  span_plane(n, u, v);
  Vec3 const centre = (box.min + box.max) * 0.5;
  double const reach = norm(box.max - box.min);
  Vec3 const foot = centre - n * dot(centre - point, n);
  std::vector<Vec3> polygon{foot - u * reach - v * reach, foot + u * reach - v * reach, foot + u * reach + v * reach,
                            foot - u * reach + v * reach};
  double const slack = 1e-9 * reach;  // faces of a container lie in the box's own faces
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 direction;
    direction[axis] = 1;
    polygon = clip(polygon, box.min - direction * slack, direction);
    polygon = clip(polygon, box.max + direction * slack, -direction);
  }
  return polygon;
}

TriangleMesh wall_surface(ResultsWallBody const& wall) {
  AnalyticSdf const& f = wall.formula;
  double const radius = f.half_size.x, h = f.half_size.z;
  switch (wall.kind) {
    case WallSolidKind::plane:
    case WallSolidKind::mesh:
    case WallSolidKind::sheet:
    case WallSolidKind::terrain:
      return wall.mesh;
    case WallSolidKind::box:
      return box_surface(f.half_size);
    case WallSolidKind::cylinder:
      return revolved({{0, -h}, {radius, -h}, {radius, h}, {0, h}});
    case WallSolidKind::bore:
      return revolved({{radius, h}, {radius, -h}});
    case WallSolidKind::funnel:
      return funnel_surface(f);
    case WallSolidKind::capsule: {
      std::vector<ProfilePoint> profile;
      add_arc(profile, 0, -h, radius, -pi / 2, 0);
      add_arc(profile, 0, h, radius, 0, pi / 2);
      return revolved(profile);
    }
  }
  return {};
}

WallPose wall_pose(ResultsHeader const& header, Frame const& frame, int index) {
  ResultsWallBody const& wall = header.wall_body[index];
  if (!wall.moving) return {wall.position, wall.orientation};
  std::size_t const moving = moving_walls(header);
  if (frame.wall_position.size() != moving || frame.wall_orientation.size() != moving)
    throw std::invalid_argument("the frame has another number of moving walls than the header");
  auto const row = std::count_if(header.wall_body.begin(), header.wall_body.begin() + index,
                                 [](ResultsWallBody const& w) { return w.moving; });
  return {frame.wall_position[row], frame.wall_orientation[row]};
}

std::vector<Vec3> plane_outline(ResultsHeader const& header, int index) {
  ResultsWall const& wall = header.wall[index];
  if (!(wall.radius > 0)) return plane_in_box(wall.point, wall.normal, header.domain);
  Vec3 u, v;
  span_plane(normalized(wall.normal), u, v);
  std::vector<Vec3> ring = circle(wall.radius);
  for (Vec3& p : ring) p = wall.point + u * p.x + v * p.y;
  return ring;
}

TriangleMesh posed_wall(ResultsHeader const& header, Frame const& frame, int index) {
  WallPose const pose = wall_pose(header, frame, index);
  Mat3 const rotation = to_matrix(pose.orientation);
  TriangleMesh mesh = wall_surface(header.wall_body[index]);
  if (mesh.triangle.empty()) return fan(plane_in_box(pose.position, rotation * Vec3{0, 0, 1}, header.domain));
  for (Vec3& v : mesh.vertex) v = pose.position + rotation * v;
  return mesh;
}

WallPhi::WallPhi(ResultsWallBody const& wall) : wall_(&wall) {
  if (wall.kind < WallSolidKind::mesh) return;
  bool const terrain = wall.kind == WallSolidKind::terrain;
  tree_ = std::make_unique<MeshTree>(terrain ? terrain_ground(wall.mesh) : wall.mesh, MeshBorder::open);
}

double WallPhi::operator()(Vec3 point, Vec3* gradient) const {
  if (!tree_) return signed_distance(wall_->formula, point, gradient);
  return wall_->kind == WallSolidKind::sheet ? sheet_distance(tree_->sdf(), wall_->half_wall, point, gradient)
                                             : mesh_distance(tree_->sdf(), point, gradient);
}

}  // namespace scree
