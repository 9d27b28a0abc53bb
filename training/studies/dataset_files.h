// dataset_files.h: the benchmark sets as mesh files with a table of their form.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

// "superellipsoids125", "grains20"
std::vector<std::string> const& dataset_names();

// Writes <folder>/<shape with - for />.stl a shape, and <folder>/<name>.csv: sizes, volume, area, sphericity,
// convexity, EI, FI, radii, in units of d. Superellipsoids: the table is that of the formula, and `cells`
// (ZeroSetOptions) says how fine the meshes are. Returns the number of shapes. Throws std::invalid_argument for an
// unknown name, std::runtime_error naming a file that cannot be written.
int write_dataset(std::string const& name, std::filesystem::path const& folder, int cells);

}  // namespace scree
