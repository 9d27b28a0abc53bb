// measure_region.h: the box or cylinder a measurement looks at.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/case_measure.h"

namespace scree {

class MeasureRegion {
 public:
  explicit MeasureRegion(MeasureCase const& m) : box_(m.box), cylinder_(m.cylinder) {}

  bool everywhere() const { return !box_ && !cylinder_; }
  double volume() const;  // [m3]; infinite without a region
  bool contains(Vec3 x) const;
  enum class Relation { outside, cut, inside };
  // Of a ball with the region; `cut` may also be said of a ball that is barely outside a corner.
  Relation relation(Vec3 centre, double radius) const;
  // Share of the segment that lies inside, 0..1.
  double share_of_segment(Vec3 from, Vec3 to) const;
  // Position between the ends of the region along its axis (z of a box), 0..1 inside.
  double along(Vec3 x) const;
  double length() const;  // along the axis [m]

 private:
  std::optional<Box> box_;
  std::optional<MeasureCylinder> cylinder_;
};

}  // namespace scree
