// cost_table.h: what `scree cost` measured, as comma-separated values and as the price list.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/cost_meters.h"

namespace scree {

// Which offers (price, error) no other one beats: cheaper and no less accurate, or more accurate and no dearer. Of
// equal ones the first. An error of 0 counts like any other.
std::vector<char> pareto_front(std::vector<std::pair<double, double>> const& offers);

// A line a row, first the columns' names with their units.
std::string query_csv(std::vector<QueryRow> const& rows);
std::string collision_csv(std::vector<CollisionRow> const& rows);
std::string cost_csv(std::vector<CostRow> const& rows);
std::string effect_csv(std::vector<EffectRow> const& rows);  // ratios: to the first row
std::string skin_csv(std::vector<SkinRow> const& rows);

// Markdown: what is on the front of error against time at rest, by error, and the rows of the last subject.
std::string price_list(std::vector<CostRow> const& rows, std::vector<QueryRow> const& queries);

}  // namespace scree
