// scree_folder.h: the output folder of a run: never overwritten unasked, never shared by two runs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace scree {

// What a run does with the content of its output folder.
enum class FolderUse { fresh, replace, resume };

class OutputFolder {
 public:
  // What can be known without touching anything: throws InputError when the folder has content and is to be fresh,
  // std::system_error when it is in use by another run or is not a folder.
  static void check(std::filesystem::path const& folder, FolderUse use);

  // Makes the folder, locks it for this process and, to replace, removes what an earlier run left (our files only).
  // Throws as check(), and std::system_error when the folder cannot be written.
  OutputFolder(std::filesystem::path folder, FolderUse use);
  ~OutputFolder();
  OutputFolder(OutputFolder const&) = delete;
  OutputFolder& operator=(OutputFolder const&) = delete;

  std::filesystem::path const& path() const { return path_; }
  std::filesystem::path file(char const* name) const { return path_ / name; }
  static std::filesystem::path checkpoints(std::filesystem::path const& folder) { return folder / "checkpoint"; }
  static bool has_results(std::filesystem::path const& folder);  // of an earlier run

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

}  // namespace scree
