// shape_input.cpp: see shape_input.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/shape_input.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace scree {

namespace fs = std::filesystem;

void check_output(fs::path const& file, bool force) {
  if (fs::is_directory(file)) throw std::invalid_argument(file.string() + " is a folder; name a file");
  if (fs::exists(file) && !force)
    throw std::invalid_argument(file.string() + " exists; choose another name or add --force");
  fs::path const folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw std::system_error(std::make_error_code(std::errc::no_such_file_or_directory), folder.string());
  if (::access(folder.c_str(), W_OK) != 0)
    throw std::system_error(errno, std::generic_category(), folder.string() + " cannot be written");
}

}  // namespace scree
