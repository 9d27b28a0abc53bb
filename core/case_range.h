// case_range.h: numbers of a case against the range they must be in.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace scree {

// "" where low < value <= high, or low <= value where `low_allowed`; else what to tell the user. NaN and infinity are
// always out of range.
std::string out_of_range(double value, double low, bool low_allowed, double high, char const* reason);

}  // namespace scree
