// sampled_grains.h: shapes made for one case: drawn from the codes of a category, or on the line between two codes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/case.h"
#include "kernels/base/span.h"
#include "shapes/generate.h"

namespace scree {

// One key of `sample` by which grains are screened, and where generation looks for it.
struct FormScreen {
  char const* key;
  Interval SampleCase::*wanted;
  Interval ShapeLimits::*limit;
  char const* meaning;
};
Span<FormScreen const> form_screens();

struct MadeShapes {
  std::vector<Shape> shape;  // certified by what phi tells; networks are those of `from`
  std::string note;          // how many were tried and why the others were not taken
};

// The shapes of an entry with `sample` or `interpolate`, made from its library `from`: one a grain, but a single one
// where t is a number. The gate is the case's: limits.gradient and limits.falling, one piece without holes. Draws come
// from the seed and `group` (place of the entry) alone. Throws std::invalid_argument: unknown category or shape, shapes
// without codes, steps of a fixed line that fail the gate, and with the counts by reason when too few draws pass.
// Each try takes about 0.5 s for a 6x64 network and thread.
MadeShapes make_shapes(Library const& from, GrainsCase const& grains, LimitsCase const& limits, std::uint64_t seed,
                       int group, int threads);

// "ballast/mix": what the names of the shapes of an entry called "mix" begin with.
std::string made_category(GrainsCase const& grains);

}  // namespace scree
