// scree_folder.cpp: see scree_folder.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/scree_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/case.h"
#include "core/checkpoint_folder.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

char constexpr lock_name[] = ".lock";

[[noreturn]] void fail(int error, std::string const& what) {
  throw std::system_error(error, std::generic_category(), what);
}

// A lock that dies with its process, so that a killed run leaves nothing to clean up. -1 with errno: not taken.
int take_lock(fs::path const& file, int flags) {
  int const descriptor = ::open(file.c_str(), flags | O_CLOEXEC, 0644);
  if (descriptor < 0) return -1;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  int const error = errno;
  ::close(descriptor);
  errno = error;
  return -1;
}

[[noreturn]] void refuse_in_use(fs::path const& folder) {
  fail(EBUSY,
       folder.string() + ": another run is writing into this output folder; wait for it or choose another --output");
}

// What an earlier run wrote; foreign files stay.
char const* const result_names[] = {"case.effective.toml",
                                    "results.h5",
                                    "results.h5.partial",
                                    "results.h5.partial.model",
                                    "ledger.csv",
                                    "measures.csv",
                                    "contacts.csv",
                                    "stages.json",
                                    "run.log"};

void remove_results(fs::path const& folder) {
  for (char const* name : result_names) fs::remove(folder / name);
  fs::remove_all(folder / "paraview");
  CheckpointFolder(OutputFolder::checkpoints(folder)).remove_all();
}

}  // namespace

bool OutputFolder::has_results(fs::path const& folder) {
  std::error_code error;
  for (char const* name : result_names)
    if (fs::exists(folder / name, error)) return true;
  return false;
}

void OutputFolder::check(fs::path const& folder, FolderUse use) {
  std::error_code error;
  fs::file_status const status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) return;
  if (status.type() != fs::file_type::directory)
    fail(ENOTDIR, folder.string() + ": is not a folder; choose another --output");
  int const lock = take_lock(folder / lock_name, O_RDWR);
  if (lock >= 0) ::close(lock);
  if (lock < 0 && errno == EWOULDBLOCK) refuse_in_use(folder);
  for (fs::directory_entry const& entry : fs::directory_iterator(folder))
    if (use == FolderUse::fresh && entry.path().filename() != lock_name)
      throw InputError(
          {fmt::format("{}: the output folder exists and is not empty; use --force to replace its results, --resume "
                       "to go on from its checkpoint, or another --output",
                       folder.string())});
}

OutputFolder::OutputFolder(fs::path folder, FolderUse use) : path_(std::move(folder)) {
  check(path_, use);
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw std::system_error(error, path_.string() + ": the output folder cannot be made");
  lock_ = take_lock(path_ / lock_name, O_RDWR | O_CREAT);
  if (lock_ < 0 && errno == EWOULDBLOCK) refuse_in_use(path_);
  if (lock_ < 0) fail(errno, path_.string() + ": the output folder cannot be written");
  if (use == FolderUse::replace) remove_results(path_);
}

OutputFolder::~OutputFolder() {
  if (lock_ < 0) return;
  std::error_code ignored;
  fs::remove(path_ / lock_name, ignored);
  ::close(lock_);
}

}  // namespace scree
