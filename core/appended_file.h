// appended_file.h: a file that grows while a run goes: a record is written whole or not at all, failures name the file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace scree {

// Every function throws std::system_error with the file's name and the cause.
class AppendedFile {
 public:
  static std::int64_t constexpr all = -1;

  AppendedFile() = default;  // no file
  // Goes on behind the first `keep` bytes, which must be there (`all`: behind what there is); the rest is cut off.
  AppendedFile(std::filesystem::path const& file, std::int64_t keep);
  ~AppendedFile();
  AppendedFile(AppendedFile&& other) noexcept;
  AppendedFile& operator=(AppendedFile&& other) noexcept;

  void append(std::string_view record);  // visible to other processes at once; after a failure nothing of it is there
  void sync();                           // what was appended is on the disk after this
  std::int64_t size() const { return size_; }  // [bytes]
  bool is_open() const { return descriptor_ >= 0; }

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;
};

}  // namespace scree
