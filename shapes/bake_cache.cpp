// bake_cache.cpp: see bake_cache.h. A cached shape is a model file with one shape.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/bake_cache.h"

#include <stdexcept>

#include "shapes/bake.h"
#include "shapes/content_cache.h"

namespace scree {
namespace {

char constexpr cached_name[] = "baked";
int constexpr recipe = 2;  // counts changes of bake.cpp that alter what is made

Library bake(Library const& library, Shape const& source, BakeRequest const& request) {
  switch (request.kind) {
    case ShapeKind::grid:
      return bake_grid(library, source, request.cells, request.threads);
    case ShapeKind::mesh:
      return bake_mesh(library, source, request.cells, request.threads);
    default:
      throw std::invalid_argument("only grids and meshes are baked");
  }
}

// Two shapes may share a phi but not a name: what a file holds is phi and its bounds.
Library with_identity_of(Shape const& source, Library baked) {
  Shape& s = baked.shape.at(0);
  Shape merged = source;
  merged.kind = s.kind, merged.data = s.data;
  merged.box = s.box, merged.bounding_radius = s.bounding_radius, merged.lipschitz = s.lipschitz;
  s = merged;
  return baked;
}

}  // namespace

std::string bake_key(Library const& library, Shape const& source, BakeRequest const& request) {
  ContentHash hash;
  hash.add(recipe).add(request.kind).add(request.cells);
  hash.add(source.bounding_radius).add(source.box.min).add(source.box.max);
  return hash.add_phi(library, source).digits();
}

Library cached_bake(Library const& library, Shape const& source, BakeRequest const& request,
                    std::vector<std::string>& notes) {
  std::string const key = bake_key(library, source, request);
  if (std::optional<Library> const cached = read_cached(key, notes))
    if (cached->shape.size() == 1 && cached->shape[0].kind == request.kind) return with_identity_of(source, *cached);
  Library const baked = bake(library, source, request);
  Library kept = baked;
  kept.shape[0].name = cached_name;
  keep_cached(key, kept, "baked shapes", notes);
  return with_identity_of(source, baked);
}

}  // namespace scree
