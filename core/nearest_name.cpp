// nearest_name.cpp: see nearest_name.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/nearest_name.h"

#include <algorithm>

namespace scree {

int edit_distance(std::string const& a, std::string const& b) {
  int const rows = static_cast<int>(a.size()), columns = static_cast<int>(b.size());
  std::vector<std::vector<int>> cost(rows + 1, std::vector<int>(columns + 1));
  for (int i = 0; i <= rows; ++i) cost[i][0] = i;
  for (int j = 0; j <= columns; ++j) cost[0][j] = j;
  for (int i = 1; i <= rows; ++i)
    for (int j = 1; j <= columns; ++j) {
      int const substitution = cost[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, substitution});
      bool const swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  return cost[rows][columns];
}

std::string nearest_name(std::string const& word, std::vector<std::string> const& known) {
  std::string best;
  int best_distance = std::max(2, static_cast<int>(word.size()) / 3) + 1;
  for (std::string const& name : known) {
    int const distance = edit_distance(word, name);
    // A word with nothing in common with a short name is not a typing error of it.
    if (distance < best_distance && distance < static_cast<int>(std::max(word.size(), name.size()))) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}

std::string did_you_mean(std::string const& word, std::vector<std::string> const& known) {
  std::string const nearest = nearest_name(word, known);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}

}  // namespace scree
