// case_text.h: a case from the text of its file, for what has no file: tests, fuzzers, the reference of keys.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/case.h"
#include "core/case_reader.h"

namespace scree {

// As load_case; `file` is for messages and for finding other files.
Case case_from_text(std::string const& text, std::filesystem::path const& file);

// Every key that is asked for while `text` is read, in that order, whether it is there or not. Problems do not matter.
std::vector<AskedKey> keys_asked(std::string const& text);

}  // namespace scree
