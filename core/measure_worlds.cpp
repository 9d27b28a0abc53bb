// measure_worlds.cpp: see measure_worlds.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_worlds.h"

#include <fmt/format.h>

namespace scree {
namespace {

// Whether grains of one replica live in more than one world.
bool has_entries_apart(Case const& c) {
  int apart = 0, others = 0;
  for (GrainsCase const& g : c.grains)
    if (g.count > 0) ++(g.apart ? apart : others);
  return apart > 1 || (apart > 0 && others > 0);
}

}  // namespace

std::string check_mean_of_replicas(Case const& c, MeasureCase const& m) {
  if (!has_entries_apart(c)) return "";
  return fmt::format(
      "'{}' has no meaning where entries keep apart: their grains lie in each other. Give each entry a case of its "
      "own, "
      "or leave out `apart`",
      m.kind);
}

std::string check_one_scene(Case const& c, MeasureCase const& m) {
  if (std::string const apart = check_mean_of_replicas(c, m); !apart.empty() || c.replicas == 1) return apart;
  return fmt::format(
      "'{}' has no meaning for {} replicas at once: their grains lie in each other. Measure runs of their own: "
      "case.replicas = 1 and the seed of each, which `scree plan` names",
      m.kind, c.replicas);
}

}  // namespace scree
