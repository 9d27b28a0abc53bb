// whole_file.cpp: see whole_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/exchange/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace scree {
namespace {

namespace fs = std::filesystem;

// All of `bytes` on the disk, or false.
bool write_and_flush(fs::path const& file, std::string const& bytes) {
  int const descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  std::size_t done = 0;
  bool good = true;
  while (good && done < bytes.size()) {
    ssize_t const n = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    good = n > 0;
    if (good) done += static_cast<std::size_t>(n);
  }
  good = good && ::fsync(descriptor) == 0;
  return ::close(descriptor) == 0 && good;
}

}  // namespace

std::string read_whole_file(fs::path const& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw std::runtime_error(file.string() + ": no such file");
  if (!fs::is_regular_file(file, error)) throw std::runtime_error(file.string() + ": is no ordinary file");
  std::uintmax_t const size = fs::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  std::string bytes(error ? 0 : size, '\0');
  if (error || !in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw std::runtime_error(file.string() + ": cannot be read");
  return bytes;
}

void write_whole_file(fs::path const& file, std::string const& bytes, bool overwrite) {
  if (!overwrite && fs::exists(file)) throw std::runtime_error(file.string() + ": exists already and is left as it is");
  fs::path const temporary = file.string() + ".partial-" + std::to_string(::getpid());
  std::error_code error;
  bool const written = write_and_flush(temporary, bytes);
  if (written) fs::rename(temporary, file, error);
  if (written && !error) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw std::runtime_error(file.string() + ": cannot be written; is the disk full or the folder read-only?");
}

}  // namespace scree
