// toml_text.h: values as TOML writes them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kernels/base/vec.h"

namespace scree {

// A TOML basic string.
std::string toml_quoted(std::string const& text);

// [x, y, z] in the shortest digits that read back to the same doubles.
std::string toml_vector(Vec3 v);

}  // namespace scree
