// file_container.cpp: writing and checking the user block.
// The CRC covers the HDF5 payload and the block's own fields, so that no flipped bit passes.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/file_container.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace scree {
namespace {

static_assert(std::endian::native == std::endian::little, "the user block is written in little-endian byte order");

std::array<char, 8> constexpr magic{'\x89', 'S', 'C', 'R', 'E', 'E', '\r', '\n'};  // a text transfer breaks it visibly

// The first bytes of the file; the rest of the 512 is zero.
struct UserBlock {
  std::array<char, 8> magic;
  std::array<char, 32> kind;  // zero-terminated
  std::uint32_t version;
  std::uint32_t crc32;  // of this block with crc32 = 0, then of the payload
  std::uint64_t payload_length;
};
static_assert(sizeof(UserBlock) == 56 && sizeof(UserBlock) <= container_block_size);

class File {
 public:
  File(std::filesystem::path const& path, int flags)
      : path_(path), descriptor_(::open(path.c_str(), flags | O_CLOEXEC)) {
    if (descriptor_ < 0) fail("cannot open");
  }
  ~File() { ::close(descriptor_); }
  File(File const&) = delete;
  File& operator=(File const&) = delete;

  // Reads up to `count` bytes; fewer only at the end of the file.
  std::size_t read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count) {
      ssize_t const n = ::read(descriptor_, to + done, count - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail("cannot read");
      if (n == 0) break;
      done += static_cast<std::size_t>(n);
    }
    return done;
  }
  void write_at_start(char const* from, std::size_t count) {
    std::size_t done = 0;
    while (done < count) {
      ssize_t const n = ::pwrite(descriptor_, from + done, count - done, static_cast<off_t>(done));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail("cannot write");
      done += static_cast<std::size_t>(n);
    }
  }
  void sync() {
    if (::fsync(descriptor_) != 0) fail("cannot flush to disk");
  }

 private:
  [[noreturn]] void fail(char const* what) const {
    throw std::system_error(errno, std::generic_category(), path_.string() + ": " + what);
  }
  std::filesystem::path path_;
  int descriptor_;
};

using Header = std::array<char, container_block_size>;

// Reads up to so many bytes that follow; fewer only at the end.
using ReadMore = std::function<std::size_t(char* to, std::size_t count)>;

// CRC over the header (its crc32 field taken as zero) and everything that follows; also counts what follows.
std::uint32_t checksum(ReadMore const& read, Header header, std::uint64_t& payload_length) {
  std::memset(header.data() + offsetof(UserBlock, crc32), 0, sizeof(UserBlock::crc32));
  uLong crc = ::crc32(0, reinterpret_cast<Bytef const*>(header.data()), header.size());
  std::vector<char> buffer(1 << 18);
  payload_length = 0;
  while (std::size_t const n = read(buffer.data(), buffer.size())) {
    crc = ::crc32(crc, reinterpret_cast<Bytef const*>(buffer.data()), static_cast<uInt>(n));
    payload_length += n;
  }
  return static_cast<std::uint32_t>(crc);
}

void sync_folder(std::filesystem::path const& file) {
  std::filesystem::path const folder = file.has_parent_path() ? file.parent_path() : ".";
  File(folder, O_RDONLY | O_DIRECTORY).sync();
}

void check_content(std::string const& name, ReadMore const& read, std::string const& kind, std::uint32_t max_version) {
  auto const refuse = [&](std::string const& what) { throw std::runtime_error(name + ": " + what); };
  Header bytes{};
  std::size_t const got = read(bytes.data(), bytes.size());
  if (got == 0) refuse("is empty; make or fetch it again");
  UserBlock block;
  std::memcpy(&block, bytes.data(), sizeof(block));
  if (got < sizeof(block) || block.magic != magic) refuse("is not a Scree file; a \"" + kind + "\" file is needed");
  block.kind.back() = '\0';
  std::string const found = block.kind.data();
  if (got < bytes.size())
    refuse("is cut short inside its first " + std::to_string(bytes.size()) + " bytes; fetch it again");
  std::uint64_t length = 0;
  std::uint32_t const crc = checksum(read, bytes, length);
  // A kind or version that the checksum vouches for is a mix-up; otherwise the file is damaged.
  bool const intact = crc == block.crc32 && length == block.payload_length;
  if (intact && found != kind) refuse("is a \"" + found + "\" file; a \"" + kind + "\" file is needed");
  if (intact && block.version > max_version)
    refuse("has format version " + std::to_string(block.version) + ", this program reads up to " +
           std::to_string(max_version) + "; use a newer Scree");
  if (length < block.payload_length)
    refuse("is cut short: " + std::to_string(length) + " of " + std::to_string(block.payload_length) +
           " bytes after the header; fetch it again");
  if (!intact) refuse("is damaged (its checksum does not match); fetch or make it again");
}

}  // namespace

void seal_container(std::filesystem::path const& temporary, std::filesystem::path const& final_name,
                    std::string const& kind, std::uint32_t version) {
  UserBlock block{};
  if (kind.size() >= block.kind.size()) throw std::invalid_argument("seal_container: kind '" + kind + "' is too long");
  block.magic = magic;
  kind.copy(block.kind.data(), kind.size());
  block.version = version;
  {
    File file(temporary, O_RDWR);
    Header bytes{};
    if (file.read(bytes.data(), bytes.size()) != bytes.size())
      throw std::system_error(std::make_error_code(std::errc::invalid_argument),
                              temporary.string() + ": shorter than its user block");
    // The length is part of the checksum, so it is settled before the payload is read.
    block.payload_length = std::filesystem::file_size(temporary) - container_block_size;
    bytes.fill(0);
    std::memcpy(bytes.data(), &block, sizeof(block));
    std::uint64_t length = 0;
    block.crc32 = checksum([&](char* to, std::size_t count) { return file.read(to, count); }, bytes, length);
    std::memcpy(bytes.data(), &block, sizeof(block));
    file.write_at_start(bytes.data(), bytes.size());
    file.sync();
  }
  std::error_code error;
  std::filesystem::file_status const old = std::filesystem::status(final_name, error);
  if (std::filesystem::exists(old) && !std::filesystem::is_regular_file(old))  // a device, say
    throw std::system_error(EINVAL, std::generic_category(), final_name.string() + ": is no ordinary file");
  std::filesystem::rename(temporary, final_name, error);
  if (error) throw std::system_error(error, final_name.string() + ": cannot be put in place of the old file");
  sync_folder(final_name);
}

void check_container(std::filesystem::path const& file_name, std::string const& kind, std::uint32_t max_version) {
  auto const refuse = [&](char const* what) { throw std::runtime_error(file_name.string() + what); };
  std::error_code error;
  std::filesystem::file_status const status = std::filesystem::status(file_name, error);
  if (status.type() == std::filesystem::file_type::not_found) refuse(": no such file; check the path");
  if (status.type() == std::filesystem::file_type::directory) refuse(": is a folder; name the file inside it");
  File file(file_name, O_RDONLY);
  check_content(
      file_name.string(), [&](char* to, std::size_t count) { return file.read(to, count); }, kind, max_version);
}

void check_container(std::string const& name, std::span<std::uint8_t const> bytes, std::string const& kind,
                     std::uint32_t max_version) {
  auto const read = [&](char* to, std::size_t count) {
    std::size_t const n = std::min(count, bytes.size());
    if (n > 0) std::memcpy(to, bytes.data(), n);
    bytes = bytes.subspan(n);
    return n;
  };
  check_content(name, read, kind, max_version);
}

}  // namespace scree
