// whole_file.cpp: see whole_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace scree {
namespace {

namespace fs = std::filesystem;

// All of `bytes` in `file`; 0, or the error.
int write_all(fs::path const& file, int flags, std::string const& bytes, bool flush) {
  int const descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | flags, 0666);
  if (descriptor < 0) return errno;
  int error = 0;
  for (std::size_t done = 0; error == 0 && done < bytes.size();) {
    ssize_t const n = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n > 0)
      done += static_cast<std::size_t>(n);
    else if (n == 0 || errno != EINTR)
      error = n == 0 ? EIO : errno;
  }
  if (error == 0 && flush && ::fsync(descriptor) != 0) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  return error;
}

// Through a temporary file; 0, or the error.
int replace(fs::path const& file, std::string const& bytes, bool flush) {
  fs::path const temporary = file.string() + ".partial-" + std::to_string(::getpid());
  std::error_code failed;
  int error = write_all(temporary, O_CREAT | O_TRUNC, bytes, flush);
  if (error == 0) fs::rename(temporary, file, failed);
  if (failed) error = failed.value();
  if (error != 0) fs::remove(temporary, failed);
  return error;
}

// Whichever way the kind of file asks for. Throws std::system_error.
void write_any_file(fs::path const& file, std::string const& bytes, bool flush) {
  std::error_code error;
  fs::file_status const status = fs::status(file, error);
  int failed = 0;
  if (fs::is_directory(status))
    failed = EISDIR;
  else if (fs::exists(status) && !fs::is_regular_file(status))
    failed = write_all(file, 0, bytes, false);
  else
    failed = replace(fs::is_symlink(file, error) ? fs::weakly_canonical(file) : file, bytes, flush);
  if (failed != 0) throw std::system_error(failed, std::generic_category(), file.string() + ": cannot be written");
}

}  // namespace

std::string read_whole_file(fs::path const& file) {
  auto const refuse = [&](char const* what) { throw std::runtime_error(file.string() + what); };
  std::error_code error;
  if (!fs::exists(file, error)) refuse(": no such file");
  if (fs::is_directory(file, error)) refuse(": is a folder");
  if (!fs::is_regular_file(file, error)) refuse(": is no ordinary file");
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(": cannot be opened");
  std::uintmax_t const size = fs::file_size(file, error);
  std::string bytes(error ? 0 : size, '\0');
  if (error || !in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) refuse(": cannot be read");
  return bytes;
}

void write_whole_file(fs::path const& file, std::string const& bytes, bool overwrite) {
  std::error_code error;
  if (!overwrite && fs::exists(file, error))
    throw std::runtime_error(file.string() + ": exists already and is left as it is");
  write_any_file(file, bytes, true);
}

void replace_whole_file(fs::path const& file, std::string const& bytes) { write_any_file(file, bytes, false); }

}  // namespace scree
