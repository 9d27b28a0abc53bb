// body_reduce.cpp: pair results to body wrenches in a fixed order, and the critical time step. See contact_reduce.h.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include "kernels/base/parallel.h"
#include "kernels/base/prefetch.h"
#include "kernels/contact_reduce.h"

namespace scree {
namespace {

struct ReduceBody {
  SceneView scene;
  Span<const PairResult> result;
  Span<const char> in_contact;
  Span<const RollingResult> rolling;  // empty: none
  Span<const int> first, entry;
  Span<Wrench> elastic, damping, friction;
  Span<double> stiffness;
  Span<Vec3> couple;  // of rolling resistance

  SCREE_HD static Wrench share(PairWrench const& w, bool as_a) {
    return as_a ? Wrench{w.force_on_a, w.torque_a} : Wrench{-w.force_on_a, w.torque_b};
  }

  // Pairs that a body opens stand side by side; those it closes are anywhere.
  SCREE_HD void prefetch_body(int i) const {
    for (int k = first[i]; k < first[i + 1]; ++k)
      if (entry[k] % 2 != 0 && in_contact[entry[k] / 2]) prefetch(result, entry[k] / 2);
  }

  SCREE_HD void operator()(int i) const {
    if (i + 2 < scene.solids()) prefetch_body(i + 2);  // bodies have several contacts each
    Wrench e, d, f;
    Vec3 c;
    double s = 0;
    Vec3 const inertia = scene.inertia[i];
    double least = inertia.x < inertia.y ? inertia.x : inertia.y;
    least = inertia.z < least ? inertia.z : least;
    for (int k = first[i]; k < first[i + 1]; ++k) {
      if (!in_contact[entry[k] / 2]) continue;
      PairResult const& r = result[entry[k] / 2];
      bool const as_a = entry[k] % 2 == 0;
      e += share(r.elastic, as_a);
      d += share(r.damping, as_a);
      f += share(r.friction, as_a);
      s += r.stiffness * (1 / scene.mass[i] + (as_a ? r.arm2_a : r.arm2_b) / least);
      if (rolling.empty()) continue;
      RollingResult const& turn = rolling[entry[k] / 2];
      c += turn.torque_on_a * (as_a ? 1.0 : -1.0);
      s += turn.stiffness / least;
    }
    if (!couple.empty()) couple[i] = c;
    elastic[i] = e, damping[i] = d, friction[i] = f, stiffness[i] = s;
  }
};

}  // namespace

void assign_pairs_to_bodies(int bodies, Span<const Pair> pair, PairsOfBodies& pairs) {
  pairs.first.assign(bodies + 1, 0);
  for (Pair const& p : pair) {
    ++pairs.first[p.a + 1];
    if (!p.with_plane()) ++pairs.first[p.b + 1];
  }
  for (int i = 0; i < bodies; ++i) pairs.first[i + 1] += pairs.first[i];
  pairs.entry.resize(pairs.first[bodies]);
  std::vector<int> at(pairs.first.begin(), pairs.first.end() - 1);
  for (int k = 0; k < pair.size(); ++k) {
    pairs.entry[at[pair[k].a]++] = 2 * k;
    if (!pair[k].with_plane()) pairs.entry[at[pair[k].b]++] = 2 * k + 1;
  }
}

void reduce_to_bodies(Queue const& queue, SceneView const& scene, Span<const PairResult> result,
                      Span<const char> in_contact, Span<const RollingResult> rolling, PairsOfBodies const& pairs,
                      BodyWrenches& bodies) {
  int const n = scene.solids();
  bodies.elastic.resize(n);
  bodies.damping.resize(n);
  bodies.friction.resize(n);
  bodies.stiffness.resize(n);
  if (!rolling.empty() || !bodies.rolling.empty()) bodies.rolling.resize(n);
  parallel_for(queue, "integrate/wrenches", n,
               ReduceBody{scene, result, in_contact, rolling, pairs.first, pairs.entry, bodies.elastic, bodies.damping,
                          bodies.friction, bodies.stiffness, bodies.rolling},
               128);
}

double critical_time_step(SceneView const&, Span<const Pair> pair, Span<const PairResult> result,
                          Span<const char> in_contact, Span<const RollingResult> rolling,
                          Span<const double> stiffness) {
  // Of all pairs the largest omega^2 / factor^2, so that one root at the end does for all; pairs of the same materials,
  // most often neighbours in the list, share the damping factor.
  double fastest = 0, zeta_of_factor = 0, factor2 = 1;
  for (int k = 0; k < pair.size(); ++k) {
    if (!in_contact[k]) continue;
    double const omega2 = stiffness[pair[k].a] + (pair[k].with_plane() ? 0 : stiffness[pair[k].b]);
    double const turning = rolling.empty() ? 0 : rolling[k].damping_ratio;
    double const zeta = std::max(result[k].damping_ratio, turning);
    if (zeta != zeta_of_factor) {
      double const factor = std::sqrt(1 + zeta * zeta) - zeta;
      zeta_of_factor = zeta, factor2 = factor * factor;
    }
    if (omega2 > fastest * factor2) fastest = omega2 / factor2;
  }
  return fastest > 0 ? 2 / std::sqrt(fastest) : std::numeric_limits<double>::infinity();
}

}  // namespace scree
