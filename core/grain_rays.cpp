// grain_rays.cpp: see grain_rays.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/grain_rays.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {

namespace {

double constexpr ball_margin = 1.01;  // of the bounding radius; networks may be evaluated up to 1.1
int constexpr leaf_size = 4;

Box around(Vec3 centre, double radius) {
  Vec3 const r{radius, radius, radius};
  return {centre - r, centre + r};
}
Box united(Box a, Box const& b) {
  for (int i = 0; i < 3; ++i) {
    a.min[i] = std::min(a.min[i], b.min[i]);
    a.max[i] = std::max(a.max[i], b.max[i]);
  }
  return a;
}

bool ray_meets(Box const& box, Ray const& ray) {
  double enter = 0, leave = ray.limit;
  for (int i = 0; i < 3; ++i) {
    double const inverse = 1 / ray.direction[i];
    double a = (box.min[i] - ray.origin[i]) * inverse, b = (box.max[i] - ray.origin[i]) * inverse;
    if (a > b) std::swap(a, b);
    enter = a > enter ? a : enter;  // a NaN (0 times infinity) changes nothing
    leave = b < leave ? b : leave;
  }
  return enter <= leave;
}

double distance_to(Box const& box, Vec3 p) {
  Vec3 gap;
  for (int i = 0; i < 3; ++i) gap[i] = std::max({box.min[i] - p[i], p[i] - box.max[i], 0.0});
  return norm(gap);
}

}  // namespace

GrainRays::GrainRays(ResultsHeader const& header, Frame const& frame, std::shared_ptr<NetworkDevice> device)
    : header_(header), phi_(header, frame, std::move(device)) {
  std::size_t const n = frame.position.size();
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += header.diameter[i];
    Shape const& s = header.library.shape.at(static_cast<std::size_t>(header.shape[i]));
    if (frame.is_active(i) && is_finite(frame.position[i]))
      balls_.push_back({frame.position[i], ball_margin * s.bounding_radius * header.diameter[i], static_cast<int>(i)});
  }
  if (n > 0) mean_diameter_ = sum / static_cast<double>(n);
  if (!balls_.empty()) {
    build(0, static_cast<int>(balls_.size()));
    bounds_ = nodes_[0].box;
  }
}

int GrainRays::build(int first, int count) {
  int const self = static_cast<int>(nodes_.size());
  Box box = around(balls_[first].centre, balls_[first].radius);
  for (int i = first + 1; i < first + count; ++i) box = united(box, around(balls_[i].centre, balls_[i].radius));
  nodes_.push_back({box, first, count, -1});
  if (count <= leaf_size) return self;
  Vec3 const size = box.max - box.min;
  int const axis = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
  std::nth_element(balls_.begin() + first, balls_.begin() + first + count / 2, balls_.begin() + first + count,
                   [axis](Ball const& a, Ball const& b) { return a.centre[axis] < b.centre[axis]; });
  build(first, count / 2);
  int const right = build(first + count / 2, count - count / 2);
  nodes_[self].right = right;
  return self;
}

void GrainRays::collect(Ray const& ray, std::vector<Visit>& visits) const {
  if (nodes_.empty()) return;
  int stack[64], depth = 0;
  for (stack[depth++] = 0; depth > 0;) {
    int const index = stack[--depth];
    Node const& node = nodes_[index];
    if (!ray_meets(node.box, ray)) continue;
    if (node.right >= 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      Vec3 const to = balls_[i].centre - ray.origin;
      double const along = dot(to, ray.direction), off2 = norm2(to) - along * along;
      double const half2 = balls_[i].radius * balls_[i].radius - off2;
      if (half2 <= 0) continue;
      double const half = std::sqrt(half2), enter = std::max(0.0, along - half), leave = along + half;
      if (leave > 0 && enter < ray.limit) visits.push_back({enter, leave, i});
    }
  }
}

void GrainRays::near(Vec3 point, double reach, std::vector<int>& found) const {
  if (nodes_.empty()) return;
  int stack[64], depth = 0;
  for (stack[depth++] = 0; depth > 0;) {
    int const index = stack[--depth];
    Node const& node = nodes_[index];
    if (distance_to(node.box, point) > reach) continue;
    if (node.right >= 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i)
      if (norm(point - balls_[i].centre) < balls_[i].radius + reach) found.push_back(i);
  }
}

void GrainRays::trace(std::vector<Ray> const& rays, std::vector<RayHit>& hits, bool any) const {
  struct Course {
    int ray, next, end;  // the visits still to make
  };
  hits.assign(rays.size(), {});
  std::vector<Visit> visits;
  std::vector<Course> courses;
  std::vector<BallWalk> walks;  // of each course, through its present ball
  // Into the next ball, unless what is found already lies in front of it.
  auto const enter_next = [&](Course& c, BallWalk& walk) {
    if (c.next == c.end) return false;
    RayHit const& hit = hits[c.ray];
    Visit const& v = visits[c.next++];
    if (hit.body >= 0 && (any || v.enter > hit.distance)) return false;
    int const body = balls_[v.ball].body;
    double const d = header_.diameter[body], end = hit.body >= 0 ? hit.distance : rays[c.ray].limit;
    walk = {body,
            phi_.in_body_frame(body, rays[c.ray].origin),
            phi_.turned_to_body(body, rays[c.ray].direction),
            v.enter / d,
            std::min(v.leave, end) / d,
            0};
    return true;
  };
  for (int r = 0; r < static_cast<int>(rays.size()); ++r) {
    int const begin = static_cast<int>(visits.size());
    collect(rays[r], visits);
    std::sort(visits.begin() + begin, visits.end(), [](Visit const& a, Visit const& b) { return a.enter < b.enter; });
    Course c{r, begin, static_cast<int>(visits.size())};
    BallWalk walk;
    if (enter_next(c, walk)) courses.push_back(c), walks.push_back(walk);
  }
  while (!walks.empty()) {
    phi_.step(walks);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < walks.size(); ++i) {
      Course c = courses[i];
      BallWalk walk = walks[i];
      if (walk.step == walk_hit) hits[c.ray] = {walk.body, walk.at * header_.diameter[walk.body]};
      if (walk.step < 0 && !enter_next(c, walk)) continue;
      courses[kept] = c;
      walks[kept++] = walk;
    }
    courses.resize(kept);
    walks.resize(kept);
  }
}

void GrainRays::normals(std::vector<Vec3> const& points, std::vector<int> const& bodies,
                        std::vector<Vec3>& normals) const {
  std::vector<BodyPoint> queries(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) queries[i] = {bodies[i], points[i]};
  std::vector<double> phi;
  phi_.evaluate(queries, phi, &normals);
  for (Vec3& n : normals) n = norm2(n) > 0 ? -normalized(n) : Vec3{0, 0, 1};
}

void GrainRays::clearance(std::vector<Vec3> const& points, double reach, std::vector<double>& distance) const {
  distance.assign(points.size(), reach);
  std::vector<BodyPoint> queries;
  std::vector<double> before;  // from the point to its ball
  std::vector<int> owner, found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    found.clear();
    near(points[i], reach, found);
    for (int b : found) {
      Ball const& ball = balls_[b];
      Vec3 const from_centre = points[i] - ball.centre;
      double const r = norm(from_centre), gap = std::max(0.0, r - ball.radius);
      queries.push_back({ball.body, gap > 0 ? ball.centre + from_centre * (ball.radius / r) : points[i]});
      before.push_back(gap);
      owner.push_back(static_cast<int>(i));
    }
  }
  std::vector<double> phi;
  phi_.evaluate(queries, phi, nullptr);
  for (std::size_t k = 0; k < queries.size(); ++k)
    distance[owner[k]] = std::min(distance[owner[k]], before[k] - phi[k]);
}

}  // namespace scree
