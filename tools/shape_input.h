// shape_input.h: what the commands of `scree-shape` and `scree-train` ask of the files that they read and write.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>

namespace scree {

// What reading finds wrong is the input's fault, whatever the reader calls it: std::runtime_error becomes
// std::invalid_argument.
template <class Read>
auto read_input(Read const& read) {
  try {
    return read();
  } catch (std::runtime_error const& error) {
    throw std::invalid_argument(error.what());
  }
}

// Throws std::invalid_argument when `file` is a folder or exists (unless `force`), std::system_error when its folder
// does not exist or cannot be written: before any work is done.
void check_output(std::filesystem::path const& file, bool force);

}  // namespace scree
