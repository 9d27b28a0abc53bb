// sphere_contacts.cpp: spheres against spheres and smooth walls in closed form: one contact, no nodes, no network.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/parallel.h"
#include "kernels/base/prefetch.h"
#include "kernels/contact_laws.h"
#include "kernels/contact_reduce.h"
#include "kernels/rolling.h"

namespace scree {
namespace {

// Of a pair in closed form: Hertz's force starts softly by itself, so it needs no straight line below an onset.
SCREE_HD PressureLaw law_of_spheres(PressureLaw const& law, double radius) {
  PressureLaw out = law_at_radius(law, radius);
  if (out.kind == ContactLaw::hertz) out.onset = 0;
  return out;
}

// Where a ball meets its partner. Both arms of two balls lie along n, and so does a's against a wall.
struct Touch {
  Vec3 n;              // from b to a
  double overlap;      // [m]
  double effective;    // R [m]
  double lever_a;      // contact point - centroid of a is -lever_a n [m]
  double lever_b = 0;  // ... of b lever_b n, of two balls [m]
  Vec3 arm_b;          // ... of a wall that is a body, which may be anywhere [m]
};

struct SpherePair {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  ContactOptions options;
  Span<const Pair> pair;
  Span<const char> closed_form;
  Span<const Vec3> history_xi;
  Span<const double> history_stiffness;
  Span<Vec3> next_xi;  // empty without friction
  Span<double> next_stiffness;
  RollingView rolling;
  Span<PairResult> result;
  Span<char> in_contact;

  SCREE_HD double radius(int body) const { return 0.5 * scene.diameter[body]; }

  // The gap between a sphere and a wall with curvatures c1, c2 opens as x^2 / (2 R1) + y^2 / (2 R2) with
  // 1/R1 = 1/r + c1; the law's integral over it is that of a sphere with R = sqrt(R1 R2).
  SCREE_HD static double radius_against(double r, Curvatures c) {
    double const least = 1e-3 / r;  // a sphere that nearly fits its bore: the closed form ends here
    double const first = 1 / r + c.first, second = 1 / r + c.second;
    return 1 / std::sqrt((first > least ? first : least) * (second > least ? second : least));
  }

  // The contact point lies half way into the overlap.
  SCREE_HD Touch with_ball(Pair p, double ra, Vec3 gap) const {
    Touch t;
    double const rb = radius(p.b), distance = norm(gap);
    t.n = distance > 0 ? gap * (1 / distance) : Vec3{0, 0, 1};
    t.overlap = ra + rb - distance;
    t.effective = ra * rb / (ra + rb);
    t.lever_a = ra - 0.5 * t.overlap;
    t.lever_b = rb - 0.5 * t.overlap;
    return t;
  }

  // ... on a wall, on the wall.
  SCREE_HD Touch with_wall(Pair p, double ra) const {
    Touch t;
    Vec3 const xa = state.position[p.a];
    if (p.with_plane()) {
      PlaneRecord const& plane = scene.plane[p.plane()];
      t.n = plane.normal;
      t.overlap = ra - dot(t.n, xa - plane.point);
      t.effective = ra;
    } else {
      Mat3 const& rotation = kinematics.rotation[p.b];
      Vec3 const local = transposed_times(rotation, xa - state.position[p.b]);
      Vec3 gradient;
      t.overlap = ra + signed_distance(scene.shape_record(p.b).analytic, local, &gradient);
      t.n = rotation * -gradient;
      t.effective = radius_against(ra, wall_curvatures(scene.shape_record(p.b).analytic, local));
      t.arm_b = xa - t.n * (ra - t.overlap) - state.position[p.b];
    }
    t.lever_a = ra - t.overlap;
    return t;
  }

  SCREE_HD void leave(int k) const {
    if (in_contact[k]) result[k] = {}, in_contact[k] = 0;
  }

  SCREE_HD void operator()(int k) const {
    if (int const next = k + prefetch_ahead; next < pair.size() && pair[next].b >= 0 && closed_form[next]) {
      prefetch(state.position, pair[next].b);
      if (in_contact[next]) prefetch(state.velocity, pair[next].b), prefetch(kinematics.spin, pair[next].b);
    }
    if (!next_xi.empty()) next_xi[k] = {}, next_stiffness[k] = 0;
    if (!closed_form[k]) return;
    if (rolling.on()) rolling.next_angle[k] = {}, rolling.next_stiffness[k] = 0, rolling.result[k] = {};
    Pair const p = pair[k];
    double const ra = radius(p.a);
    bool const two_balls = !p.with_plane() && !scene.is_wall(p.b);
    ContactParameters const& parameters = contact_parameters(scene, p);
    double const reach = parameters.cohesion.traction > 0 ? parameters.cohesion.reach() : 0;
    if (two_balls) {  // most pairs of a list do not touch: they cost no root
      Vec3 const gap = state.position[p.a] - state.position[p.b];
      double const touching = ra + radius(p.b) + reach;
      if (norm2(gap) >= touching * touching) return leave(k);
      meet(k, p, parameters, with_ball(p, ra, gap), true);
    } else {
      Touch const t = with_wall(p, ra);
      if (!(t.overlap > -reach)) return leave(k);
      meet(k, p, parameters, t, false);
    }
  }

  SCREE_HD void meet(int k, Pair p, ContactParameters const& parameters, Touch const& t, bool two_balls) const {
    PairResult& out = result[k];
    if (!in_contact[k]) in_contact[k] = 1;
    bool const wall_body = !two_balls && !p.with_plane();
    out.active = 1;
    out.arm2_a = t.lever_a * t.lever_a;
    out.arm2_b = two_balls ? t.lever_b * t.lever_b : norm2(t.arm_b);
    double adhesion = 0, adhesive_energy = 0, adhesive_stiffness = 0;
    if (parameters.cohesion.traction > 0) {
      double const girth = 2 * SphereLaw::pi * t.effective;
      adhesion = girth * parameters.cohesion.energy(t.overlap);
      adhesive_energy = girth * parameters.cohesion.energy_integral(t.overlap);
      adhesive_stiffness = -girth * parameters.cohesion.pressure(t.overlap);
    }
    double force = 0, energy = 0, stiffness = 0, total = 0, k_t = 0, lost = 0, stored = 0;
    Vec3 drag, turning;   // friction on a, and its cross product with n
    if (t.overlap > 0) {  // adhesion does not damp, and friction lives on the force of the law
      SphereLaw const law{law_of_spheres(parameters.normal, t.effective), t.effective};
      force = law.force(t.overlap), energy = law.energy(t.overlap), stiffness = law.stiffness(t.overlap);
      // Arms along n take no part in m_e, and walls are infinitely heavy.
      double const ma = scene.mass[p.a], mb = two_balls ? scene.mass[p.b] : 0;
      double const mass = two_balls ? ma * mb / (ma + mb) : ma;
      Vec3 const wa = kinematics.spin[p.a], wb = p.with_plane() ? Vec3{} : kinematics.spin[p.b];
      Vec3 v = state.velocity[p.a], rolled = wa * t.lever_a;
      if (!p.with_plane()) v -= state.velocity[p.b];
      if (two_balls) rolled += wb * t.lever_b;
      if (wall_body) v -= cross(wb, t.arm_b);
      v -= cross(rolled, t.n);
      double const closing = dot(t.n, v);
      total = force - 2 * parameters.damping_sphere * std::sqrt(mass * stiffness) * closing;
      total = total > 0 ? total : 0;
      k_t = law.tangential(t.overlap) * parameters.tangential;
      if (parameters.friction > 0 && k_t > 0) {
        double const softness = 1 / k_t;
        Vec3 old = restored(history_xi[k], history_stiffness[k], k_t);
        if (norm2(old) > 0) old = laid_flat(turned_by((wa + wb) * (0.5 * options.time_step), old), t.n);
        TangentialResult const slid =
            slide(old, v - t.n * closing, options.time_step, 2 * parameters.damping_sphere * std::sqrt(mass * softness),
                  parameters.friction * total * softness);
        next_xi[k] = slid.xi;
        next_stiffness[k] = k_t;
        drag = slid.traction * -k_t;
        turning = cross(t.n, drag);
        stored = 0.5 * k_t * norm2(slid.xi);
        lost = k_t * slid.loss;
      }
    }
    out.elastic = {t.n * (force + adhesion), {}, {}};
    out.damping = {t.overlap > 0 ? t.n * (total - force) : Vec3{}, {}, {}};
    out.friction = {drag, turning * -t.lever_a, two_balls ? turning * -t.lever_b : -cross(t.arm_b, drag)};
    if (wall_body) {  // a normal force has no lever arm about a ball's centre, but it may have one about a wall's
      out.elastic.torque_b = -cross(t.arm_b, out.elastic.force_on_a);
      out.damping.torque_b = -cross(t.arm_b, out.damping.force_on_a);
    }
    out.energy_normal = energy + adhesive_energy;
    out.energy_tangential = stored;
    out.friction_loss = lost;
    out.overlap = t.overlap > 0 ? t.overlap : 0;
    out.damping_ratio = t.overlap > 0 ? parameters.damping_sphere : 0;
    out.stiffness = (parameters.friction > 0 && k_t > stiffness ? k_t : stiffness) + adhesive_stiffness;
    if (rolling.on() && t.overlap > 0)
      resist_rolling(scene, kinematics, rolling, p, k, options.time_step, t.n, total, stiffness, out.arm2_a,
                     out.arm2_b);
  }
};

}  // namespace

void sphere_contacts(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                     ContactOptions const& options, Span<const Pair> pair, Span<const char> closed_form,
                     SphereHistory const& history, SphereHistory& next, RollingView const& rolling,
                     Span<PairResult> result, Span<char> in_contact) {
  if (scene.friction) {
    next.xi.resize(pair.size());
    next.stiffness.resize(pair.size());
  }
  parallel_for(queue, "sphere_contacts/pairs", pair.size(),
               SpherePair{scene, state, kinematics, options, pair, closed_form, history.xi, history.stiffness, next.xi,
                          next.stiffness, rolling, result, in_contact},
               256);
}

}  // namespace scree
