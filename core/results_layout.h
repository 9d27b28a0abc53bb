// results_layout.h: what the results file calls things; shared by its writer and its reader.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/results.h"

namespace scree::results_layout {

char constexpr kind[] = "scree.results";
std::uint32_t constexpr version = 1;

// Columns of /ledger, in this order [s], [J]. /ledger_columns names those a file has; a file without it is older
// and has `unnamed_columns` beside those of every run.
struct LedgerColumn {
  char const* name;
  double LedgerRow::*value;
  bool every_run = true;
};
std::array<LedgerColumn, 18> constexpr ledger{{{"time", &LedgerRow::time},
                                               {"kinetic", &LedgerRow::kinetic},
                                               {"potential", &LedgerRow::potential},
                                               {"elastic_normal", &LedgerRow::elastic_normal},
                                               {"elastic_tangential", &LedgerRow::elastic_tangential},
                                               {"inserted", &LedgerRow::inserted, false},
                                               {"wall_work", &LedgerRow::wall_work},
                                               {"damping", &LedgerRow::damping},
                                               {"friction", &LedgerRow::friction},
                                               {"global_damping", &LedgerRow::global_damping, false},
                                               {"removed", &LedgerRow::removed},
                                               {"applied", &LedgerRow::applied, false},
                                               {"drag", &LedgerRow::drag, false},
                                               {"elastic_rolling", &LedgerRow::elastic_rolling, false},
                                               {"rolling", &LedgerRow::rolling, false},
                                               {"deleted", &LedgerRow::deleted, false},
                                               {"residual", &LedgerRow::residual},
                                               {"moved", &LedgerRow::moved}}};
static_assert(sizeof(LedgerRow) == ledger.size() * sizeof(double), "a ledger entry has no column");

std::array<char const*, 2> constexpr unnamed_columns{"inserted", "global_damping"};

// Those of every run and those named in `more`.
inline std::vector<LedgerColumn> columns_with(std::vector<std::string> const& more) {
  std::vector<LedgerColumn> out;
  for (LedgerColumn const& column : ledger)
    if (column.every_run || std::find(more.begin(), more.end(), column.name) != more.end()) out.push_back(column);
  return out;
}

// Arrays of Vec3 and Quat are written as they lie in memory.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double));

}  // namespace scree::results_layout
