// case_reference.h: the reference of the case file's keys, made from the code that reads them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case_reader.h"

namespace scree {

// Every key of every kind that the parser asks for, a call each, in its order: it reads a text that has each table.
std::vector<AskedKey> all_keys_asked();

// Markdown: a table a section with type, default, range and meaning of each key, then the kinds of [[measure]]. Types,
// choices and defaults are those of the parser's own calls, ranges and meanings those of core/case_keys.h.
// `prefix`: only keys that start with it ("grains.insert"); "": all. Empty where there is none.
std::string case_reference(std::string const& prefix = "");

}  // namespace scree
