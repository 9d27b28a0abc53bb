// case_identity.h: whether two runs are of the same case: what a restart has to agree with.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "core/scene.h"

namespace scree {

// The effective case without what may change between a run and its continuation: time.end, [output], [checkpoint],
// limits.overlap, limits.ledger, and the folders that files lie in.
std::string case_identity(Case const& c);

// Hash (FNV-1a) of what the case reads from files: networks, codes, radii, grids and meshes of shapes and walls, tables
// of poses. Equal on every machine, except for grids and meshes baked at the start.
std::uint64_t inputs_hash(Case const& c, Scene const& scene);

// First difference of two identities in words: "[[contact]] friction = 0.5, this case friction = 0.6"; empty: none.
std::string first_difference(std::string const& theirs, std::string const& ours);

}  // namespace scree
