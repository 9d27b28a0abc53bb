// plot_script.h: runs tools/python/plot_study.py, which is part of the program.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace scree {

// Draws <folder>/<study>.png and .svg from the study's CSV files with Debian's Python and its Matplotlib. Returns "" or
// what prevented it, in one line.
std::string plot_study(std::string const& study, std::filesystem::path const& folder);

}  // namespace scree
