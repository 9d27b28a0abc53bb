// nearest_site.h: which of a set of surface sites is nearest to a surface point, facing the same way.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kernels/base/vec.h"

namespace scree {

// Sites in a uniform grid. Sites that face away from the point (the far side of a thin part) are passed over.
class NearestSite {
 public:
  // `normal`: outward unit normals of the sites; `spacing`: about the distance between sites [d].
  NearestSite(std::vector<Vec3> const& site, std::vector<Vec3> const& normal, double spacing);

  // Index of the nearest site to x whose normal does not oppose `normal`; without one, of the nearest; -1 if empty.
  // Ties go to the smaller index.
  int find(Vec3 x, Vec3 normal) const;

 private:
  int cell_of(double x, int axis) const;
  int search(Vec3 x, Vec3 normal, double least_cosine) const;

  std::vector<Vec3> site_, normal_;  // in grid order
  std::vector<int> index_;           // their original index
  std::vector<int> first_;           // of each cell
  Vec3 low_;
  double inverse_cell_ = 1, cell_ = 1;
  int size_[3] = {1, 1, 1};
};

}  // namespace scree
