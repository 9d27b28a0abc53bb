// case_wall.h: [[wall]] entries of a case: reading, checking and writing them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "core/case.h"
#include "core/case_reader.h"

namespace scree {

void read_wall(CaseReader r, WallCase& out);

// Everything wrong with the values of one wall: `fail` gets the key within the wall and what is wrong.
void check_wall(WallCase const& wall, std::function<void(std::string const& key, std::string text)> const& fail);

// The entry with every default written out.
std::string wall_to_toml(WallCase const& wall);

}  // namespace scree
