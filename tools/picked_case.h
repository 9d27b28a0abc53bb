// picked_case.h: a case as a command takes it: read, and with what [accuracy] asks for picked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/accuracy.h"
#include "tools/scree_commands.h"

namespace scree {

struct PickedCase {
  Case c;                            // without [accuracy]
  std::optional<AccuracyPick> pick;  // what was picked now; empty: nothing was asked for, or it was picked before
  std::vector<std::string> words;    // about it, a line each
};

// `earlier`: folder of a run to go on with, whose picks hold; empty: none. Throws InputError.
PickedCase load_picked_case(CaseArguments const& arguments, std::filesystem::path const& earlier = {});

// case.effective.toml: the case, and above it as comments what was picked.
std::string effective_text(PickedCase const& picked);

}  // namespace scree
