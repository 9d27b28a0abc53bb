// case_run_text.h: [accuracy], [device], [output], [checkpoint], [relax], [limits] of a case: read, judged, written.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case.h"
#include "core/case_reader.h"

namespace scree {

void read_run(CaseReader& root, Case& out);

// Appends what is wrong with the values.
void check_run(Case const& c, std::vector<CaseProblem>& found);

// The tables as TOML, every default written out; [accuracy], [device], [checkpoint] and [relax] where the
// case has them.
std::string run_to_toml(Case const& c);

}  // namespace scree
