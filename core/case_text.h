// case_text.h: a case from the text of its file, for what has no file: tests and fuzzers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/case.h"

namespace scree {

// As load_case; `file` is for messages and for finding other files.
Case case_from_text(std::string const& text, std::filesystem::path const& file);

}  // namespace scree
