// cases.h: small cases built in code, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case.h"

namespace scree::testing {

// One material "rock" (2650 kg/m3) against itself: Winkler, kappa of k_n = 2e6 N/m at 1 % of d = 0.1 m.
inline Case rock_case() {
  Case c;
  c.name = "test";
  c.material = {{"rock", 2650}};
  ContactCase contact;
  contact.pair = {"rock", "rock"};
  c.contact = {contact};
  c.limits.overlap = 0.5;
  return c;
}

// Grains of one shape at given positions, at rest, axes along the world's.
inline GrainsCase grains_at(std::string const& shape, std::vector<Vec3> const& position, double diameter = 0.1,
                            int nodes = 1000) {
  GrainsCase g;
  g.name = "grain";
  g.material = "rock";
  g.shapes = {shape};
  g.nodes = nodes;
  g.count = static_cast<int>(position.size());
  g.diameter = diameter;
  g.insert.kind = InsertCase::Kind::list;
  g.insert.orientation = Orientation::aligned;
  g.insert.position = position;
  return g;
}

inline WallCase floor_at(double z) {
  WallCase w;
  w.name = "floor";
  w.material = "rock";
  w.point = {0, 0, z};
  return w;
}

inline WallCase open_box(Vec3 min, Vec3 max) {
  WallCase w;
  w.name = "container";
  w.material = "rock";
  w.kind = WallKind::box;
  w.min = min, w.max = max;
  w.open = {"+z"};
  return w;
}

}  // namespace scree::testing
