// case_effects_text.h: effects on bodies in the case file: read, judged, written back. See case_effects.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case.h"
#include "core/case_reader.h"

namespace scree {

void read_effects(CaseReader& root, Case& out);

// Appends what is wrong with the values.
void check_effects(Case const& c, std::vector<CaseProblem>& found);

// The tables as TOML, every default written out; empty when the case has none.
std::string effects_to_toml(Case const& c);

}  // namespace scree
