// checkpoint_folder.cpp: see checkpoint_folder.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <system_error>

#include "core/case.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

char constexpr stopped_name[] = "stopped.h5";

// "step_000000001234.h5": names sort as steps do.
bool is_checkpoint(fs::path const& file) {
  std::string const name = file.stem().string();
  return file.extension() == ".h5" && name.size() == 17 && name.starts_with("step_") &&
         std::all_of(name.begin() + 5, name.end(), [](unsigned char c) { return std::isdigit(c); });
}

void make_folder(fs::path const& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::system_error(error, folder.string() + ": the folder cannot be made");
}

}  // namespace

std::vector<fs::path> CheckpointFolder::files() const {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_entry const& entry : fs::directory_iterator(path_, error))
    if (is_checkpoint(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

fs::path CheckpointFolder::write(Checkpoint const& checkpoint, int keep) const {
  make_folder(path_);
  fs::path const file = path_ / fmt::format("step_{:012}.h5", checkpoint.state.step);
  write_checkpoint(file, checkpoint);
  std::vector<fs::path> const all = files();
  for (std::size_t i = 0; i + std::size_t(std::max(keep, 1)) < all.size(); ++i) fs::remove(all[i]);
  return file;
}

fs::path CheckpointFolder::write_stopped(Checkpoint const& checkpoint) const {
  make_folder(path_);
  fs::path const file = path_ / stopped_name;
  write_checkpoint(file, checkpoint);
  return file;
}

std::optional<Checkpoint> CheckpointFolder::newest(std::vector<std::string>& messages) const {
  std::vector<fs::path> candidates = files();
  std::error_code error;
  if (fs::exists(path_ / stopped_name, error)) candidates.insert(candidates.begin(), path_ / stopped_name);
  std::vector<std::string> reasons;
  for (std::size_t i = candidates.size(); i-- > 0;) {
    try {
      Checkpoint out = read_checkpoint(candidates[i]);
      for (std::string const& reason : reasons) messages.push_back("passed by: " + reason);
      return out;
    } catch (InputError const& e) {
      reasons.insert(reasons.end(), e.problems.begin(), e.problems.end());
    }
  }
  if (reasons.empty()) return std::nullopt;
  reasons.push_back(path_.string() + ": no checkpoint here can be used; --force starts the run anew");
  throw InputError(reasons);
}

void CheckpointFolder::remove_all() const {
  for (fs::path const& file : files()) fs::remove(file);
  fs::remove(path_ / stopped_name);
  fs::remove(journal());
  std::error_code left_alone;
  std::vector<fs::path> partial;
  for (fs::directory_entry const& entry : fs::directory_iterator(path_, left_alone))
    if (fs::path const whole = fs::path(entry.path()).replace_extension();
        entry.path().extension() == ".partial" && (is_checkpoint(whole) || whole.filename() == stopped_name))
      partial.push_back(entry.path());
  for (fs::path const& file : partial) fs::remove(file);
  fs::remove(path_, left_alone);  // fails where foreign files are
}

}  // namespace scree
