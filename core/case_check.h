// case_check.h: what is wrong with a Case that was read: ranges, names, pairs. Opens no files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case.h"
#include "core/case_reader.h"

namespace scree {

std::vector<CaseProblem> check_case(Case const& c);

// "grains.0.diameter" -> "grains.mix.diameter", the way --set takes it.
std::string key_by_name(Case const& c, std::string const& key);

}  // namespace scree
