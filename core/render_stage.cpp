// render_stage.cpp: see render_stage.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/render_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {

namespace {

double constexpr infinity = std::numeric_limits<double>::infinity();
double constexpr floor_slope = 0.5;  // a wall whose normal rises this much is a floor: steeper than 60 degrees is not

double smooth_step(double from, double to, double x) {
  double const t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Closest approach of a ray and a segment: distance between them, and where along the ray.
double approach(Ray const& ray, Vec3 from, Vec3 to, double& along_ray) {
  Vec3 const u = to - from, w = ray.origin - from;
  double const uu = dot(u, u), ud = dot(u, ray.direction), wu = dot(w, u), wd = dot(w, ray.direction);
  double const denominator = uu - ud * ud;
  double const s = denominator > 1e-12 * uu ? std::clamp((wu - ud * wd) / denominator, 0.0, 1.0) : 0.0;
  along_ray = std::max(0.0, s * ud - wd);
  return norm(ray.origin + ray.direction * along_ray - (from + u * s));
}

}  // namespace

RenderStage::RenderStage(ResultsHeader const& header, RenderWalls const& walls, Box const& grains) {
  bool glass = false;
  for (ResultsWall const& w : header.wall) {
    Vec3 const n = normalized(w.normal);
    panels_.push_back({w.point, n, n.z > floor_slope, true});
    glass = glass || n.z <= floor_slope;
  }
  shown_ = grains;
  if (auto const& around = walls.bounds())
    for (int i = 0; i < 3; ++i) {
      shown_.min[i] = std::min(shown_.min[i], around->min[i]);
      shown_.max[i] = std::max(shown_.max[i], around->max[i]);
    }
  if (glass)  // a container is shown whole, as wide as it is
    for (int i = 0; i < 2; ++i) {
      shown_.min[i] = std::min(shown_.min[i], header.domain.min[i]);
      shown_.max[i] = std::max(shown_.max[i], header.domain.max[i]);
    }
  Vec3 const centre = (shown_.min + shown_.max) * 0.5;
  for (Panel const& p : panels_)
    if (p.floor) shown_.min.z = std::min(shown_.min.z, centre.z - dot(p.normal, centre - p.point) / p.normal.z);
  size_ = norm(shown_.max - shown_.min);
  for (RenderWalls::Edge const& e : walls.edges()) edges_.push_back({e.from, e.to});
  if (!glass) return;
  double const top = std::min(header.domain.max.z, grains.max.z + 0.06 * size_);
  shown_.max.z = std::max(shown_.max.z, top);
  panels_.push_back({{0, 0, top}, {0, 0, -1}, false, false});
  Vec3 const slack = Vec3{1, 1, 1} * (1e-6 * size_);
  Vec3 const low = header.domain.min - slack, high = header.domain.max + slack;
  for (int i = 0; i < 2; ++i) {
    Vec3 axis;
    axis[i] = 1;
    panels_.push_back({low, axis, false, false});
    panels_.push_back({high, -axis, false, false});
  }
  find_edges();
}

bool RenderStage::within(Vec3 point, std::size_t except, std::size_t except_too) const {
  for (std::size_t k = 0; k < panels_.size(); ++k)
    if (k != except && k != except_too && dot(panels_[k].normal, point - panels_[k].point) < -1e-6 * size_)
      return false;
  return true;
}

// Edges: intersections of two panels of which one is glass, as far as all others allow.
void RenderStage::find_edges() {
  for (std::size_t i = 0; i < panels_.size(); ++i)
    for (std::size_t j = i + 1; j < panels_.size(); ++j) {
      Panel const &a = panels_[i], &b = panels_[j];
      bool const cut = !b.drawn && b.normal.z == -1;  // the rim
      if (!a.drawn || (!b.drawn && !cut) || (a.floor && (b.floor || cut))) continue;
      Vec3 const u = cross(a.normal, b.normal);
      double const uu = norm2(u);
      if (uu < 1e-9) continue;
      double const da = dot(a.normal, a.point), db = dot(b.normal, b.point);
      Vec3 const origin = cross(b.normal * da - a.normal * db, u) * (1 / uu);
      double from = -infinity, to = infinity;
      for (std::size_t k = 0; k < panels_.size(); ++k) {
        if (k == i || k == j) continue;
        double const slope = dot(panels_[k].normal, u), gap = dot(panels_[k].normal, origin - panels_[k].point);
        if (std::abs(slope) < 1e-9) {
          if (gap < -1e-5 * size_) to = -infinity;
        } else if (slope > 0) {
          from = std::max(from, -gap / slope);
        } else {
          to = std::min(to, -gap / slope);
        }
      }
      if (to > from && std::isfinite(to) && std::isfinite(from)) edges_.push_back({origin + u * from, origin + u * to});
    }
}

double RenderStage::floor_distance(Ray const& ray) const {
  double nearest = infinity;
  for (Panel const& p : panels_) {
    double const toward = dot(p.normal, ray.direction);
    if (!p.floor || toward >= -1e-9) continue;
    double const t = dot(p.normal, p.point - ray.origin) / toward;
    if (t > 0) nearest = std::min(nearest, t);
  }
  return nearest;
}

Vec3 RenderStage::floor_normal(Vec3 point) const {
  Vec3 normal{0, 0, 1};
  double nearest = infinity;
  for (Panel const& p : panels_)
    if (double const h = std::abs(dot(p.normal, point - p.point)); p.floor && h < nearest)
      nearest = h, normal = p.normal;
  return normal;
}

double RenderStage::height(Vec3 point) const {
  double lowest = infinity;
  for (Panel const& p : panels_)
    if (p.floor) lowest = std::min(lowest, dot(p.normal, point - p.point));
  return lowest;
}

double RenderStage::glass(Ray const& ray, double distance) const {
  double passes = 1;
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    Panel const& p = panels_[i];
    double const toward = dot(p.normal, ray.direction);
    if (!p.drawn || p.floor || toward >= -1e-9) continue;  // seen from behind: cut away
    double const t = dot(p.normal, p.point - ray.origin) / toward;
    if (t <= 0 || t >= distance || !within(ray.origin + ray.direction * t, i, i)) continue;
    passes *= 1 - (0.16 + 0.25 * std::pow(1 + toward, 3.0));  // more at grazing incidence
  }
  return 1 - passes;
}

double RenderStage::edges(Ray const& ray, double distance, double pixel) const {
  double covered = 0;
  for (Edge const& e : edges_) {
    double t = 0;
    double const off = approach(ray, e.from, e.to, t);
    if (t <= 0 || t > distance * (1 + 1e-3)) continue;
    covered = std::max(covered, 1 - smooth_step(0.5, 1.5, off / (t * pixel)));
  }
  return covered;
}

CameraFrame::CameraFrame(Camera const& camera) {
  forward = normalized(camera.target - camera.eye);
  Vec3 const side = cross(forward, {0, 0, 1});
  right = norm2(side) > 1e-12 ? normalized(side) : Vec3{1, 0, 0};  // straight down or up: +x to the right
  up = cross(right, forward);
}

Camera fitted_camera(Box const& box, RenderOptions const& options) {
  Camera camera;
  double const size = std::max(norm(box.max - box.min), 1e-9), fill = 0.90;
  Vec3 const from{std::cos(options.azimuth) * std::cos(options.elevation),
                  std::sin(options.azimuth) * std::cos(options.elevation), std::sin(options.elevation)};
  double const half_height = std::tan(camera.field_of_view / 2);
  double const half_width = half_height * options.width / options.height;
  camera.target = (box.min + box.max) * 0.5;
  double distance = 2 * size / half_height;
  for (int pass = 0; pass < 20; ++pass) {  // centre what shows, then scale the distance: converges in a few
    camera.eye = camera.target + from * distance;
    CameraFrame const frame(camera);
    double low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 const p{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                   corner & 4 ? box.max.z : box.min.z};
      Vec3 const to = p - camera.eye;
      double const depth = std::max(dot(to, frame.forward), 1e-3 * size);
      double const at[2] = {dot(to, frame.right) / depth / half_width, dot(to, frame.up) / depth / half_height};
      for (int i = 0; i < 2; ++i) low[i] = std::min(low[i], at[i]), high[i] = std::max(high[i], at[i]);
    }
    camera.target += frame.right * (0.5 * (low[0] + high[0]) * distance * half_width) +
                     frame.up * (0.5 * (low[1] + high[1]) * distance * half_height);
    distance *= std::clamp(0.5 * std::max(high[0] - low[0], high[1] - low[1]) / fill, 0.5, 2.0);
  }
  camera.eye = camera.target + from * distance;
  return camera;
}

}  // namespace scree
