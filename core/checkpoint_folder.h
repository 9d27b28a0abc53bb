// checkpoint_folder.h: the checkpoints of one run: the last N are kept, the newest that is whole is gone on from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/checkpoint.h"

namespace scree {

// Files: step_<12 digits>.h5; stopped.h5, the state that a watch stopped at; frames.log (core/frame_journal.h).
class CheckpointFolder {
 public:
  explicit CheckpointFolder(std::filesystem::path folder) : path_(std::move(folder)) {}

  // Writes the checkpoint under the number of its step and then removes all but the last `keep`. Throws
  // std::system_error; the older checkpoints are then untouched.
  std::filesystem::path write(Checkpoint const& checkpoint, int keep) const;
  // The state that a watch stopped at: not counted among the last N.
  std::filesystem::path write_stopped(Checkpoint const& checkpoint) const;

  // The newest checkpoint that is whole, or without any the state that a watch stopped at. What is passed by goes to
  // `messages`, a line each with the reason. Throws InputError when there are files and none is whole.
  std::optional<Checkpoint> newest(std::vector<std::string>& messages) const;

  std::vector<std::filesystem::path> files() const;  // of checkpoints, oldest first, without stopped.h5
  std::filesystem::path journal() const { return path_ / "frames.log"; }
  void remove_all() const;  // everything of ours, and the folder if nothing else is in it

 private:
  std::filesystem::path path_;
};

}  // namespace scree
