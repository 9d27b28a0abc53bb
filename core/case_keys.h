// case_keys.h: every key of the case file with a line of documentation: one table. What has no row cannot be read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kernels/base/span.h"

namespace scree {

// Types, choices and defaults are not here: the reference (core/case_reference.h) takes them from the code that reads.
struct CaseKey {
  char const* path;      // dotted, entries of lists without their index: "contact.normal.stiffness"
  char const* range;     // of a number, "[0, 1)"; "": any, or the meaning says it
  char const* fallback;  // what an absent key means where no default value says it; "": the default, or required
  char const* meaning;   // Markdown, with units in brackets
};

// In the order of the reference.
Span<CaseKey const> case_keys();

// The row of a path with or without indices ("contact.0.pair"); null: there is no such key.
CaseKey const* find_case_key(std::string const& path);

// The path without the indices of list entries.
std::string without_indices(std::string const& path);

}  // namespace scree
