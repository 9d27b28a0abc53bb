// measure_stress.cpp: see measure_stress.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_stress.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/measure_contacts.h"
#include "core/measure_region.h"

namespace scree {
namespace {

// Adhesion pulls a towards b.
bool pulls(MeasureView const& view, Pair p, Vec3 force) {
  if (p.with_plane()) return dot(force, view.scene.plane[p.plane()].normal) < 0;
  return p.b < view.scene.bodies() && dot(force, view.state.position[p.b] - view.state.position[p.a]) > 0;
}

bool with_wall(MeasureView const& view, Pair p) { return p.with_plane() || p.b >= view.scene.bodies(); }

}  // namespace

Vec3 contact_point(MeasureView const& view, std::size_t k) {
  PairResult const& r = view.work.result[k];
  Vec3 const force = force_on_a(r), torque = r.elastic.torque_a + r.damping.torque_a + r.friction.torque_a;
  double const size2 = norm2(force);
  // The point of the line of action that is nearest to the centroid, then along the force.
  Pair const p = view.work.pair[k];
  Vec3 const foot = cross(force, torque) / size2;
  double const on = std::sqrt(std::max(0.0, r.arm2_a - norm2(foot)) / size2);
  return view.state.position[p.a] + foot + force * (pulls(view, p, force) ? on : -on);
}

std::vector<Quantity> stress_quantities(MeasureView const&) {
  std::vector<Quantity> out;
  for (char const* name : {"xx", "yy", "zz", "xy", "xz", "yz", "pressure", "deviator"}) out.push_back({name, "Pa"});
  return out;
}

Values sample_stress(MeasureView const& view, Memory&) {
  MeasureRegion const region(view.measure);
  double s[3][3] = {};
  for (std::size_t k = 0; k < view.work.pair.size(); ++k) {
    Vec3 const force = force_on_a(view.work.result[k]);
    if (!(norm2(force) > 0)) continue;
    Pair const p = view.work.pair[k];
    Vec3 const from = view.state.position[p.a],
               to = with_wall(view, p) ? contact_point(view, k) : view.state.position[p.b];
    double const share = region.share_of_segment(from, to) / region.volume();
    Vec3 const branch = to - from;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) s[i][j] -= 0.5 * share * (force[i] * branch[j] + force[j] * branch[i]);
  }
  double const pressure = (s[0][0] + s[1][1] + s[2][2]) / 3;
  double deviator = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) deviator += 1.5 * std::pow(s[i][j] - (i == j ? pressure : 0), 2);
  return {s[0][0], s[1][1], s[2][2], s[0][1], s[0][2], s[1][2], pressure, std::sqrt(deviator)};
}

std::vector<Quantity> chain_quantities(MeasureView const&) {
  return {{"count", "-"}, {"share", "-"}, {"carried", "-"}, {"mean_force", "N"}, {"largest_force", "N"}};
}

Values sample_chains(MeasureView const& view, Memory&) {
  MeasureRegion const region(view.measure);
  std::vector<double> force;
  double sum = 0, largest = 0;
  for (std::size_t k = 0; k < view.work.pair.size(); ++k) {
    double const size = norm(force_on_a(view.work.result[k]));
    if (!(size > 0) || with_wall(view, view.work.pair[k]) || !region.contains(contact_point(view, k))) continue;
    force.push_back(size);
    sum += size;
    largest = std::max(largest, size);
  }
  double const nothing = std::numeric_limits<double>::quiet_NaN();
  if (force.empty()) return {0, nothing, nothing, nothing, nothing};
  double const n = static_cast<double>(force.size()), bound = view.measure.above * sum / n;
  double count = 0, carried = 0;
  for (double const f : force)
    if (f > bound) ++count, carried += f;
  return {count, count / n, carried / sum, sum / n, largest};
}

std::vector<ContactRow> contacts_of(MeasureView const& view) {
  MeasureRegion const region(view.measure);
  std::vector<ContactRow> out;
  for (std::size_t k = 0; k < view.work.pair.size(); ++k) {
    Vec3 const force = force_on_a(view.work.result[k]);
    if (!(norm2(force) > 0)) continue;
    Vec3 const x = contact_point(view, k);
    if (!region.contains(x)) continue;
    Pair const p = view.work.pair[k];
    int const n = view.scene.bodies();
    int const wall = p.with_plane() ? view.scene.plane[p.plane()].wall : p.b >= n ? view.scene.wall[p.b - n].wall : 0;
    out.push_back({p.a, with_wall(view, p) ? -1 - wall : p.b, x, force});
  }
  return out;
}

}  // namespace scree
