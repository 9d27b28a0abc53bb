// opponent_boxes.h: what bench_broad_phase compares with: pairs of overlapping boxes by CGAL.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/broad_phase.h"

namespace scree::bench {

// By CGAL's box_self_intersection_d, touching counts; in any order. Only where CGAL was found (SCREE_BENCH_CGAL).
std::size_t by_cgal(std::vector<Box> const& boxes, std::vector<Pair>& pairs);

}  // namespace scree::bench
