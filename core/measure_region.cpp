// measure_region.cpp: see measure_region.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace scree {
namespace {

// Narrows [low, high] to where f0 + t (f1 - f0) >= 0.
void clip(double f0, double f1, double& low, double& high) {
  if (f0 >= 0 && f1 >= 0) return;
  if (f0 < 0 && f1 < 0) {
    high = low - 1;
    return;
  }
  double const t = f0 / (f0 - f1);
  if (f0 < 0)
    low = std::max(low, t);
  else
    high = std::min(high, t);
}

// Along the axis [m] from its start, and off it.
struct AxisCoordinates {
  double along, length;
  Vec3 off;
};
AxisCoordinates about(MeasureCylinder const& c, Vec3 x) {
  Vec3 const axis = c.to - c.from;
  double const length = norm(axis);
  Vec3 const unit = axis / length;
  double const along = dot(x - c.from, unit);
  return {along, length, x - c.from - unit * along};
}

}  // namespace

double MeasureRegion::volume() const {
  if (box_) {
    Vec3 const size = box_->max - box_->min;
    return size.x * size.y * size.z;
  }
  if (cylinder_) return std::numbers::pi * cylinder_->radius * cylinder_->radius * length();
  return std::numeric_limits<double>::infinity();
}

bool MeasureRegion::contains(Vec3 x) const { return relation(x, 0) != Relation::outside; }

MeasureRegion::Relation MeasureRegion::relation(Vec3 x, double r) const {
  if (everywhere()) return Relation::inside;
  double depth = std::numeric_limits<double>::infinity();  // of the centre below the nearest face, negative outside
  if (box_) {
    for (int k = 0; k < 3; ++k) depth = std::min({depth, x[k] - box_->min[k], box_->max[k] - x[k]});
  } else {
    AxisCoordinates const a = about(*cylinder_, x);
    depth = std::min({a.along, a.length - a.along, cylinder_->radius - norm(a.off)});
  }
  if (depth >= r) return Relation::inside;
  return depth < -r ? Relation::outside : Relation::cut;
}

double MeasureRegion::share_of_segment(Vec3 from, Vec3 to) const {
  if (everywhere()) return 1;
  double low = 0, high = 1;
  if (box_) {
    for (int k = 0; k < 3; ++k) {
      clip(from[k] - box_->min[k], to[k] - box_->min[k], low, high);
      clip(box_->max[k] - from[k], box_->max[k] - to[k], low, high);
    }
  } else {
    AxisCoordinates const a = about(*cylinder_, from), b = about(*cylinder_, to);
    clip(a.along, b.along, low, high);
    clip(a.length - a.along, b.length - b.along, low, high);
    // |off + t step|^2 <= radius^2
    Vec3 const step = b.off - a.off;
    double const aa = norm2(step), ab = dot(a.off, step), c = norm2(a.off) - cylinder_->radius * cylinder_->radius;
    double const root = ab * ab - aa * c;
    if (!(aa > 0))
      high = c <= 0 ? high : low - 1;
    else if (root < 0)
      high = low - 1;
    else
      low = std::max(low, (-ab - std::sqrt(root)) / aa), high = std::min(high, (-ab + std::sqrt(root)) / aa);
  }
  return std::max(0.0, high - low);
}

double MeasureRegion::along(Vec3 x) const {
  if (cylinder_) {
    AxisCoordinates const a = about(*cylinder_, x);
    return a.along / a.length;
  }
  return (x.z - box_->min.z) / (box_->max.z - box_->min.z);
}

double MeasureRegion::length() const {
  return cylinder_ ? norm(cylinder_->to - cylinder_->from) : box_->max.z - box_->min.z;
}

}  // namespace scree
