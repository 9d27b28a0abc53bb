// bake_cache.h: baked grids and meshes kept between runs, by the content they were made from.
// Folder: $SCREE_CACHE, else $XDG_CACHE_HOME/scree, else ~/.cache/scree. A cache that cannot be used costs time only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "shapes/shape.h"

namespace scree {

struct BakeRequest {
  ShapeKind kind = ShapeKind::grid;  // grid or mesh
  int cells = 0;                     // across the bounding diameter
  int threads = 1;
};

// Where baked shapes are kept; empty when the environment names no place.
std::filesystem::path bake_cache_folder();

// 16 hexadecimal digits over everything that the result depends on: weights and code, formula, coefficients, triangles
// or values, transform, bounds, request, and for networks the instruction set.
std::string bake_key(Library const& library, Shape const& source, BakeRequest const& request);

// bake_grid or bake_mesh of bake.h, from the cache where it has it; else made and kept (atomically, so that runs may
// share the folder). A damaged file is replaced; a folder that cannot be written is one note in `notes`.
Library cached_bake(Library const& library, Shape const& source, BakeRequest const& request,
                    std::vector<std::string>& notes);

}  // namespace scree
