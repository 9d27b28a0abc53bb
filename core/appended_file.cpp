// appended_file.cpp: see appended_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/appended_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace scree {

AppendedFile::AppendedFile(std::filesystem::path const& file, std::int64_t keep)
    : path_(file), descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail(errno);
  std::int64_t const there = ::lseek(descriptor_, 0, SEEK_END);
  size_ = keep == all ? there : keep;
  int error = 0;
  if (there < 0)
    error = errno;
  else if (there < size_)
    error = EINVAL;  // bytes that were to be kept are gone
  else if (there > size_ && (::ftruncate(descriptor_, size_) != 0 || ::lseek(descriptor_, size_, SEEK_SET) != size_))
    error = errno;
  if (error == 0) return;
  ::close(descriptor_);
  fail(error);
}

AppendedFile::~AppendedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

AppendedFile::AppendedFile(AppendedFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

AppendedFile& AppendedFile::operator=(AppendedFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

void AppendedFile::append(std::string_view record) {
  for (std::size_t done = 0; done < record.size();) {
    ssize_t const n = ::write(descriptor_, record.data() + done, record.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      int const error = n < 0 ? errno : EIO;
      // Whoever reads the file finds whole records; should this fail too, the message is still the first one's.
      if (::ftruncate(descriptor_, size_) == 0) ::lseek(descriptor_, size_, SEEK_SET);
      fail(error);
    }
    done += static_cast<std::size_t>(n);
  }
  size_ += static_cast<std::int64_t>(record.size());
}

void AppendedFile::sync() {
  if (::fsync(descriptor_) != 0) fail(errno);
}

void AppendedFile::fail(int error) const {
  throw std::system_error(error, std::generic_category(), path_.string() + ": cannot be written");
}

}  // namespace scree
