// limited_disk.h: disks that are full: files that may not grow beyond a size, and small file systems of their own.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>
#include <sys/resource.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/support/shell.h"

namespace scree::testing {

// While it lives, no file of this process and its children grows beyond so many bytes: writes fail with EFBIG.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::uintmax_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit const now{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &now);
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(FileSizeLimit const&) = delete;
  FileSizeLimit& operator=(FileSizeLimit const&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = nullptr;
};

// Whether this process may have a mount namespace of its own; containers often forbid it.
inline bool can_mount() { return shell("/", "unshare -rm mount -t tmpfs none /tmp").code == 0; }

// The command with a fresh file system at folder/disk, gone when it ends. `options` as of mount: "size=300k".
inline Outcome on_small_disk(std::filesystem::path const& folder, std::string const& options,
                             std::string const& command) {
  std::filesystem::create_directories(folder / "disk");
  return shell(folder, "unshare -rm sh -c 'mount -t tmpfs -o " + options + " none disk && { " + command + "; }'");
}

}  // namespace scree::testing
