// case_measure_text.h: [[measure]] entries of a case: reading, checking and writing them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/case.h"
#include "core/case_reader.h"

namespace scree {

void read_measure(CaseReader r, MeasureCase& out);
void check_measures(Case const& c, std::vector<CaseProblem>& found);
// All entries, every default that the kind takes written out.
std::string measures_to_toml(Case const& c);

}  // namespace scree
