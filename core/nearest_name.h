// nearest_name.h: the known name closest to a mistyped one, for messages.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace scree {

// Optimal-string-alignment distance: insertions, deletions, substitutions and swaps of neighbours, 1 each.
int edit_distance(std::string const& a, std::string const& b);

// The nearest of `known`, or "" when none is within a third of the word's length (at least 2).
std::string nearest_name(std::string const& word, std::vector<std::string> const& known);

// " (did you mean 'x'?)" or "".
std::string did_you_mean(std::string const& word, std::vector<std::string> const& known);

}  // namespace scree
