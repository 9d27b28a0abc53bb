// toml_text.cpp: see toml_text.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/toml_text.h"

#include <fmt/format.h>

namespace scree {

std::string toml_quoted(std::string const& text) {
  std::string out = "\"";
  for (char const c : text) {
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      out += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    else
      out += c;
  }
  return out + "\"";
}

std::string toml_vector(Vec3 v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

}  // namespace scree
