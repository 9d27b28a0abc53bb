// measure_contacts.cpp: see measure_contacts.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_contacts.h"

#include <limits>

#include "core/measure_region.h"

namespace scree {

std::vector<Quantity> coordination_quantities(MeasureView const&) {
  return {{"grains", "-"}, {"walls", "-"}, {"together", "-"}, {"floating", "-"}};
}

Values sample_coordination(MeasureView const& view, Memory&) {
  int const n = view.scene.bodies();
  std::vector<int> with_grains(n, 0), with_walls(n, 0);
  for (std::size_t k = 0; k < view.work.pair.size(); ++k) {
    if (!(norm2(force_on_a(view.work.result[k])) > 0)) continue;
    Pair const p = view.work.pair[k];
    if (p.with_plane() || p.b >= n)
      ++with_walls[p.a];
    else
      ++with_grains[p.a], ++with_grains[p.b];
  }
  MeasureRegion const region(view.measure);
  double grains = 0, walls = 0, floating = 0, count = 0;
  for (int i = 0; i < n; ++i) {
    if (!view.state.is_active(i) || !region.contains(view.state.position[i])) continue;
    ++count;
    grains += with_grains[i];
    walls += with_walls[i];
    floating += with_grains[i] + with_walls[i] == 0;
  }
  if (count == 0) return Values(4, std::numeric_limits<double>::quiet_NaN());
  return {grains / count, walls / count, (grains + walls) / count, floating / count};
}

}  // namespace scree
