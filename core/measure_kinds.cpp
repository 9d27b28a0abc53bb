// measure_kinds.cpp: see measure_kinds.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_kinds.h"

#include <algorithm>
#include <stdexcept>

#include "core/measure_angles.h"
#include "core/measure_contacts.h"
#include "core/measure_flow.h"
#include "core/measure_motion.h"
#include "core/measure_packing.h"
#include "core/measure_stress.h"
#include "core/measure_walls.h"
#include "core/measure_worlds.h"

namespace scree {

std::vector<MeasureKind> const& measure_kinds() {
  // name, keys it needs, keys it may have, needs a region, quantities, sample, after every step, interval, check
  static std::vector<MeasureKind> const table{
      {"packing_fraction",
       {},
       {"box", "cylinder", "slices", "points"},
       true,
       packing_quantities,
       sample_packing,
       nullptr,
       false,
       check_mean_of_replicas},
      {"coordination", {}, {"box", "cylinder"}, false, coordination_quantities, sample_coordination},
      {"pile_angle",
       {},
       {"box", "cylinder", "through", "direction", "bin", "flank"},
       false,
       pile_quantities,
       sample_pile,
       nullptr,
       false,
       check_one_scene},
      {"surface_angle",
       {},
       {"wall", "axis", "through", "radius", "bin"},
       false,
       surface_quantities,
       sample_surface,
       nullptr,
       false,
       check_surface},
      {"wall_torque",
       {"wall"},
       {"axis", "through"},
       false,
       torque_quantities,
       sample_torque,
       visit_torque,
       true,
       check_torque},
      {"wall_force", {"wall"}, {}, false, wall_force_quantities, sample_wall_force, visit_wall_force, true},
      {"discharge_rate",
       {},
       {"delete", "point", "normal", "radius"},
       false,
       discharge_quantities,
       sample_discharge,
       visit_discharge,
       true,
       check_discharge},
      {"blockage",
       {"point", "normal", "longer_than"},
       {"radius", "box", "cylinder"},
       false,
       blockage_quantities,
       sample_blockage,
       visit_blockage,
       false,
       check_one_scene},
      {"stress", {}, {"box", "cylinder"}, true, stress_quantities, sample_stress, nullptr, false, check_one_scene},
      {"force_chains", {}, {"box", "cylinder", "above", "contacts"}, false, chain_quantities, sample_chains},
      {"trajectory", {"grains"}, {"index"}, false, trajectory_quantities, sample_trajectory},
      {"velocity", {}, {"grains", "box", "cylinder"}, false, velocity_quantities, sample_velocity},
      {"run_out",
       {"direction"},
       {"grains"},
       false,
       run_out_quantities,
       sample_run_out,
       visit_run_out,
       false,
       check_run_out},
  };
  return table;
}

MeasureKind const* find_measure_kind(std::string const& name) {
  for (MeasureKind const& k : measure_kinds())
    if (k.name == name) return &k;
  return nullptr;
}

MeasureKind const& measure_kind(std::string const& name) {
  if (MeasureKind const* const kind = find_measure_kind(name)) return *kind;
  throw std::logic_error("no measurement is called " + name);
}

Vec3 up_of(Case const& c) { return c.gravity && norm(*c.gravity) > 0 ? -normalized(*c.gravity) : Vec3{0, 0, 1}; }

double largest_diameter(Scene const& scene) {
  double largest = 0;
  for (int i = 0; i < scene.bodies(); ++i) largest = std::max(largest, scene.diameter[i]);
  return largest;
}

}  // namespace scree
