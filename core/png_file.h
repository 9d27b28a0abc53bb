// png_file.h: an 8-bit RGB image and its PNG file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace scree {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // row by row from the top, 3 bytes a pixel
};

// The PNG file's content. Throws std::invalid_argument when the pixels do not fill the image, std::runtime_error.
std::vector<std::uint8_t> png_bytes(Image const& image);

// Atomic: a temporary name, then rename. Throws std::system_error or std::runtime_error naming the file.
void write_png(std::filesystem::path const& file, Image const& image);

}  // namespace scree
