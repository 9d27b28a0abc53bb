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
  // name, meaning, keys it needs, keys it may have, needs a region, quantities, sample, after every step, interval,
  // check
  static std::vector<MeasureKind> const table{
      {"packing_fraction",
       "`fraction`; `error` of it; `slice_0`, ...: of equal slices along z (cylinder: its axis), 0 the lowest. Grains "
       "that the border cuts count with the share of a fixed quasi-random point set of their shape; `error` is that of "
       "as many random points, an upper bound. Overlaps count twice. A region that reaches above the bed counts the "
       "air",
       {},
       {"box", "cylinder", "slices", "points"},
       true,
       packing_quantities,
       sample_packing,
       nullptr,
       false,
       check_mean_of_replicas},
      {"coordination",
       "contacts that carry a force, mean over the grains whose centroid is in the region: with `grains`, with "
       "`walls`, `together`; `floating`: share of grains that touch nothing. Two bodies are one contact; each face of "
       "a box at rest is a body",
       {},
       {"box", "cylinder"},
       false,
       coordination_quantities,
       sample_coordination},
      {"pile_angle",
       "`angle` of repose [deg], `height`, `rms` of the tops about the line [m]. Grains that contacts connect to a "
       "wall, about the vertical through `through` (else their centre of mass), or along `direction` on both sides of "
       "it. Cells one bin wide give their highest grain; rings whose mean top lies within `flank` of the height are "
       "the flank; least squares through all their tops",
       {},
       {"box", "cylinder", "through", "direction", "bin", "flank"},
       false,
       pile_quantities,
       sample_pile,
       nullptr,
       false,
       check_one_scene},
      {"surface_angle",
       "bed of a drum: `angle` [deg], `offset` of the surface above the axis, `rms` [m]. Axis and radius from the "
       "wall's rotation and cylinder unless given. Highest centroids of cells one bin wide, in the middle third of the "
       "drum's width, least squares, once more without what lies 1.5 bins off. Positive where the surface rises on the "
       "side where the wall carries grains up; without a turning wall, towards axis x up",
       {},
       {"wall", "axis", "through", "radius", "bin"},
       false,
       surface_quantities,
       sample_surface,
       nullptr,
       false,
       check_surface},
      {"wall_torque",
       "mean since the last sample: `torque` that turns the wall against its grains, i.e. minus theirs on it [N m]; "
       "`power` = torque x rate [W], positive when the wall does work; `work` since the start [J], the ledger's "
       "`wall_work` of this wall. Axis from the wall's rotation unless given",
       {"wall"},
       {"axis", "through"},
       false,
       torque_quantities,
       sample_torque,
       visit_torque,
       true,
       check_torque},
      {"wall_force",
       "force of the grains on the wall, mean since the last sample: `x`, `y`, `z`, `size` [N]",
       {"wall"},
       {},
       false,
       wall_force_quantities,
       sample_wall_force,
       visit_wall_force,
       true},
      {"discharge_rate",
       "since the last sample `mass_rate` [kg/s], `number_rate` [1/s]; since the start `mass` [kg], `number`. "
       "Centroids through the plane along `normal`, back ones taken off, within `radius` of `point`; or grains taken "
       "by the `[[delete]]` of that name",
       {},
       {"delete", "point", "normal", "radius"},
       false,
       discharge_quantities,
       sample_discharge,
       visit_discharge,
       true,
       check_discharge},
      {"blockage",
       "`blocked`: 1 while no grain has passed the plane for longer than that, since the last one or since `from`, "
       "though grains remain before it (in the region, if given), else 0; `count` of blockages; `seconds` blocked; "
       "`longest` wait [s]",
       {"point", "normal", "longer_than"},
       {"radius", "box", "cylinder"},
       false,
       blockage_quantities,
       sample_blockage,
       visit_blockage,
       false,
       check_one_scene},
      {"stress",
       "Love-Weber mean of the contact forces, branches cut at the border, compression positive: `xx yy zz xy xz yz`, "
       "`pressure`, `deviator` (root of 3/2 s:s) [Pa]",
       {},
       {"box", "cylinder"},
       true,
       stress_quantities,
       sample_stress,
       nullptr,
       false,
       check_one_scene},
      {"force_chains",
       "contacts between grains with more than `above` mean forces: `count`, `share` of the contacts, `carried` share "
       "of the forces, `mean_force`, `largest_force` [N]",
       {},
       {"box", "cylinder", "above", "contacts"},
       false,
       chain_quantities,
       sample_chains},
      {"trajectory",
       "`0.x 0.y 0.z 0.vx 0.vy 0.vz`, ...: of the grains of an entry, counted from 0 [m], [m/s]",
       {"grains"},
       {"index"},
       false,
       trajectory_quantities,
       sample_trajectory},
      {"velocity",
       "`mean` and `largest` speed, mean velocity `x y z` [m/s], mean `spin` [rad/s]",
       {},
       {"grains", "box", "cylinder"},
       false,
       velocity_quantities,
       sample_velocity},
      {"run_out",
       "way from the place of release: `largest` and `mean` along the direction; `sideways` (largest size) and "
       "`sideways_spread` (standard deviation) across it [m]. Deleted grains count where they left",
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
