// file_container.h: the 512-byte user block before our HDF5 files (magic, kind, version, payload length, CRC32),
// checked before HDF5 opens the file, because libhdf5 1.10 itself crashes on damaged ones.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace scree {

int constexpr container_block_size = 512;  // HDF5 user blocks are 512 * 2^n bytes

// Fill in the user block of a finished HDF5 file (created with a user block of 512 bytes), fsync and rename it to
// `final_name`. Throws std::system_error with the path.
void seal_container(std::filesystem::path const& temporary, std::filesystem::path const& final_name,
                    std::string const& kind, std::uint32_t version);

// Check magic, kind, version, length and CRC. Throws std::runtime_error: "<file>: what is wrong; way out".
void check_container(std::filesystem::path const& file, std::string const& kind, std::uint32_t max_version);
// The same of a file's bytes; `name` begins the messages.
void check_container(std::string const& name, std::span<std::uint8_t const> bytes, std::string const& kind,
                     std::uint32_t max_version);

}  // namespace scree
