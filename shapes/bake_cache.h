// bake_cache.h: baked grids and meshes kept between runs, by the content they were made from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shapes/shape.h"

namespace scree {

struct BakeRequest {
  ShapeKind kind = ShapeKind::grid;  // grid or mesh
  int cells = 0;                     // across the bounding diameter
  int threads = 1;
};

// 16 hexadecimal digits over everything that the result depends on: weights and code, formula, coefficients, triangles
// or values, transform, bounds, request, and for networks the instruction set.
std::string bake_key(Library const& library, Shape const& source, BakeRequest const& request);

// bake_grid or bake_mesh of bake.h, from the cache (content_cache.h) where it has it; else made and kept. A damaged
// file is replaced; a folder that cannot be written is one note in `notes`.
Library cached_bake(Library const& library, Shape const& source, BakeRequest const& request,
                    std::vector<std::string>& notes);

}  // namespace scree
