// png_file.cpp: see png_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/png_file.h"

#include <png.h>

#include <stdexcept>
#include <string>

#include "shapes/whole_file.h"

namespace scree {

std::vector<std::uint8_t> png_bytes(Image const& image) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * std::size_t(image.width) * std::size_t(image.height))
    throw std::invalid_argument("png_bytes: the pixels do not fill the image");
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  auto const fail = [&] { throw std::runtime_error(std::string("PNG: ") + header.message); };
  if (!png_image_write_to_memory(&header, nullptr, &size, 0, image.rgb.data(), 0, nullptr)) fail();
  std::vector<std::uint8_t> bytes(size);
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr)) fail();
  bytes.resize(size);
  return bytes;
}

void write_png(std::filesystem::path const& file, Image const& image) {
  std::vector<std::uint8_t> const bytes = png_bytes(image);
  replace_whole_file(file, {bytes.begin(), bytes.end()});
}

}  // namespace scree
