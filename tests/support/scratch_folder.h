// scratch_folder.h: a folder of its own for a test, with a cache of baked shapes in it; gone when the test is over.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace scree::testing {

struct ScratchFolder {
  std::filesystem::path path;

  explicit ScratchFolder(std::string const& name)
      : path(std::filesystem::temp_directory_path() / (name + "_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path);
    ::setenv("SCREE_CACHE", (path / "cache").c_str(), 1);
  }
  ~ScratchFolder() {
    ::unsetenv("SCREE_CACHE");
    std::filesystem::remove_all(path);
  }
  ScratchFolder(ScratchFolder const&) = delete;
  ScratchFolder& operator=(ScratchFolder const&) = delete;
};

}  // namespace scree::testing
