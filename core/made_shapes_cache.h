// made_shapes_cache.h: shapes made for a case, kept between runs: a draw and its gate take a quarter of a second each.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/sampled_grains.h"

namespace scree {

// 16 hexadecimal digits over everything that make_shapes depends on: the library's networks, codes and frames, the
// entry's name, count and wishes, the gate, seed and group, and the instruction set.
std::string made_shapes_key(Library const& from, GrainsCase const& grains, LimitsCase const& limits, std::uint64_t seed,
                            int group);

// make_shapes, from the cache (shapes/content_cache.h) where it has the result, bit for bit; else made and kept. Why
// nothing could be read or kept goes to `notes`. Throws as make_shapes; refusals are not kept.
MadeShapes cached_make_shapes(Library const& from, GrainsCase const& grains, LimitsCase const& limits,
                              std::uint64_t seed, int group, int threads, std::vector<std::string>& notes);

}  // namespace scree
