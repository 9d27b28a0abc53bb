// whole_file.h: a file read or written as a whole: all of it is there, or what was there before.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace scree {

// Throws std::runtime_error "<file>: ..." for what is missing, no ordinary file, or cannot be read.
std::string read_whole_file(std::filesystem::path const& file);

// Under a temporary name beside it, flushed to the disk, then renamed; through links, and straight into what is no
// ordinary file (/dev/stdout). Throws std::runtime_error "<file>: ..." where it exists and `overwrite` is false, and
// std::system_error with the cause where it cannot be written; then nothing is left behind.
void write_whole_file(std::filesystem::path const& file, std::string const& bytes, bool overwrite);

// The same for what can be made again, over what is there and without the wait for the disk. Throws std::system_error.
void replace_whole_file(std::filesystem::path const& file, std::string const& bytes);

}  // namespace scree
