// changed_text.h: a test's text with one place changed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace scree::testing {

// `text` with the first `from` replaced by `to`. Throws std::logic_error where it is not there.
inline std::string with(std::string text, std::string const& from, std::string const& to) {
  std::size_t const at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("test text lacks: " + from);
  return text.replace(at, from.size(), to);
}

}  // namespace scree::testing
