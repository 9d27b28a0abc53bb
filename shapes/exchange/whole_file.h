// whole_file.h: a file read or written as a whole: all of it is there, or none.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace scree {

// Throws std::runtime_error "<file>: ..." for what is missing, no ordinary file, or cannot be read.
std::string read_whole_file(std::filesystem::path const& file);

// Under a temporary name, flushed to the disk, then renamed. Throws std::runtime_error "<file>: ..." where it exists
// and `overwrite` is false, or where it cannot be written; then nothing is left behind.
void write_whole_file(std::filesystem::path const& file, std::string const& bytes, bool overwrite);

}  // namespace scree
