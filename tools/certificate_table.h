// certificate_table.h: the figures of certificates as scree-shape and scree-train print them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shapes/shape.h"

namespace scree {

// A line a shape: the errors against the source, and what phi itself tells. "-": not measured.
std::string error_table(std::vector<Shape> const& shapes);
std::string phi_table(std::vector<Shape> const& shapes);

}  // namespace scree
