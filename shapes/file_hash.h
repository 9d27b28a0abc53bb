// file_hash.h: a short name for the content of a file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace scree {

// FNV-1a (64 bits) of the file's bytes, "fnv1a:0123456789abcdef": tells source meshes apart, protects against nothing.
std::string file_hash(std::filesystem::path const& file);

}  // namespace scree
