// results_layout.h: what the results file calls things; shared by its writer and its reader.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/results.h"

namespace scree::results_layout {

char constexpr kind[] = "scree.results";
std::uint32_t constexpr version = 1;

// Columns of /ledger, in this order [s], [J].
struct LedgerColumn {
  char const* name;
  double LedgerRow::*value;
};
std::array<LedgerColumn, 13> constexpr ledger{{{"time", &LedgerRow::time},
                                               {"kinetic", &LedgerRow::kinetic},
                                               {"potential", &LedgerRow::potential},
                                               {"elastic_normal", &LedgerRow::elastic_normal},
                                               {"elastic_tangential", &LedgerRow::elastic_tangential},
                                               {"inserted", &LedgerRow::inserted},
                                               {"wall_work", &LedgerRow::wall_work},
                                               {"damping", &LedgerRow::damping},
                                               {"friction", &LedgerRow::friction},
                                               {"global_damping", &LedgerRow::global_damping},
                                               {"removed", &LedgerRow::removed},
                                               {"residual", &LedgerRow::residual},
                                               {"moved", &LedgerRow::moved}}};
static_assert(sizeof(LedgerRow) == ledger.size() * sizeof(double), "a ledger entry has no column");

// Arrays of Vec3 and Quat are written as they lie in memory.
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double));

}  // namespace scree::results_layout
