// model_file.h: networks, radii, meshes, grids, codes, shapes and certificates in one HDF5 model file ("scree.model").
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "shapes/shape.h"

namespace scree {

// Atomic (temporary name + rename); never overwrites unless `overwrite`. Throws std::runtime_error naming the file.
void write_model(std::filesystem::path const& file, Library const& library, bool overwrite = false);

// Throws std::runtime_error: missing, truncated, damaged, wrong kind or version, NaN weights (names the shape or
// layer).
Library read_model(std::filesystem::path const& file);
// The same of a file's bytes; `name` begins the messages.
Library read_model(std::string const& name, std::span<std::uint8_t const> bytes);

}  // namespace scree
