// procedural_grains.h: the 20 grains of the benchmark set, five each of ballast, cobble, ellipsoid and sand.
// Made from a seed by formula, with exact volumes; the closed mesh returned here is the truth that errors refer to.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shapes/triangle_mesh.h"

namespace scree {

enum class GrainKind { ballast, cobble, ellipsoid, sand };

int constexpr grains_per_kind = 5;

struct ProceduralGrain {
  std::string name;      // "ballast/0"
  std::string category;  // "ballast"
  std::string formula;   // one line: how it was made
  TriangleMesh mesh;     // closed, normalised: volume pi/6, centroid at the origin, longest principal axis along x
};

// ballast    convex polyhedron of 12 or more faces, every edge turning by more than 30 degrees, sphericity <= 0.88
// cobble     rounded and smooth: an ellipsoid with broad bumps
// ellipsoid  triangulated so finely that it differs from the ellipsoid by 2e-4 d
// sand       lobed and bent, convexity <= 0.95; some bodies are not star-shaped
// Longest-to-shortest ratios rise with `index` (0..grains_per_kind-1) from about 1.1 to beyond 1.5. Deterministic: the
// same bodies on every machine, up to rounding. Throws std::invalid_argument for an index out of range.
ProceduralGrain procedural_grain(GrainKind kind, int index, std::uint64_t seed = 1);

// All 20, in the order of the enum.
std::vector<ProceduralGrain> procedural_grains(std::uint64_t seed = 1);

}  // namespace scree
