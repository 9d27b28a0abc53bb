// opponent_cgal.cpp: see opponent_boxes.h.
// SPDX-License-Identifier: Apache-2.0
#include <CGAL/Box_intersection_d/Box_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

#include "tools/bench/opponent_boxes.h"

namespace scree::bench {

std::size_t by_cgal(std::vector<Box> const& boxes, std::vector<Pair>& pairs) {
  using Cube = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int>;
  std::vector<Cube> cubes;
  cubes.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    double low[] = {boxes[i].min.x, boxes[i].min.y, boxes[i].min.z};
    double high[] = {boxes[i].max.x, boxes[i].max.y, boxes[i].max.z};
    cubes.emplace_back(low, high, static_cast<int>(i));
  }
  pairs.clear();
  CGAL::box_self_intersection_d(cubes.begin(), cubes.end(), [&](Cube const& a, Cube const& b) {
    pairs.push_back({std::min(a.info(), b.info()), std::max(a.info(), b.info())});
  });
  return pairs.size();
}

}  // namespace scree::bench
